# SPDX-License-Identifier: GPL-3.0-or-later
"""Plants one fault at a time in a small tree and looks whether the check that should see it does."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
SPDX = "// SPDX-License-Identifier: GPL-3.0-or-later\n"
ROOMS = """
[rooms."decomp.base"]
rooms = []
[rooms."decomp.mesh"]
rooms = ["decomp.base"]
[rooms."decomp.mesh".third_parties]
"check.cpp" = ["CGAL"]
"""
ERRORS = "| code | meaning | what to try |\n|---|---|---|\n| `mesh.empty` | nothing in it | another file |\n"


class Checks(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        shutil.copytree(HERE, self.root / "tests/house", ignore=shutil.ignore_patterns("__pycache__"))
        (self.root / "tests/house/test_checks.py").unlink()
        self.put("tests/house/rooms.toml", ROOMS)
        self.put("docs/errors.md", ERRORS)
        self.put("libdecomp/decomp/base/run.h", SPDX)
        self.put("libdecomp/decomp/mesh/check.h", SPDX + '#include "decomp/base/run.h"\n#include <vector>\n')
        self.put("libdecomp/decomp/mesh/check.cpp", SPDX + '#include <CGAL/a.h>\nauto e = fail("mesh.empty", "");\n')

    def tearDown(self):
        shutil.rmtree(self.root)

    def put(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def verdict(self, check):
        run = subprocess.run([sys.executable, "-B", f"tests/house/check_{check}.py"], cwd=self.root,
                             capture_output=True, text=True, check=False, env=dict(os.environ))
        return run.returncode, run.stdout

    def assert_fault(self, check, said):
        code, out = self.verdict(check)
        self.assertEqual(code, 1, out)
        self.assertIn(said, out)

    def test_a_sound_tree_passes(self):
        for check in ("includes", "wording", "errors"):
            code, out = self.verdict(check)
            self.assertEqual(code, 0, f"{check}: {out}")

    def test_an_edge_that_is_not_in_the_table(self):
        self.put("libdecomp/decomp/base/run.h", SPDX + '#include "decomp/mesh/check.h"\n')
        self.assert_fault("includes", "decomp.base may not include decomp.mesh")

    def test_a_cycle_in_the_table(self):
        self.put("tests/house/rooms.toml", ROOMS.replace("rooms = []", 'rooms = ["decomp.mesh"]'))
        self.assert_fault("includes", "a cycle")

    def test_a_third_party_in_a_public_header(self):
        self.put("libdecomp/decomp/mesh/check.h", SPDX + "#include <CGAL/a.h>\n")
        self.assert_fault("includes", "does not list CGAL")

    def test_a_private_header_of_another_room(self):
        self.put("libdecomp/decomp/base/run_detail.h", SPDX)
        self.put("libdecomp/decomp/mesh/check.h", SPDX + '#include "decomp/base/run_detail.h"\n')
        self.assert_fault("includes", "is private to decomp.base")

    def test_a_room_without_an_entry(self):
        self.put("libcam/cam/post/post.h", SPDX)
        self.assert_fault("includes", "room cam.post is not in rooms.toml")

    def test_an_unnamed_tolerance(self):
        self.put("libdecomp/decomp/base/run.cpp", SPDX + "bool f(double x) { return x < 1e-9; }\n")
        self.assert_fault("wording", "run.cpp:2: 1e-9")

    def test_a_named_tolerance_passes(self):
        self.put("libdecomp/decomp/base/run.cpp", SPDX + "constexpr double kSmall = 1e-9;  // 1e-9 of a turn\n")
        self.assertEqual(self.verdict("wording")[0], 0)

    def test_a_missing_licence_line(self):
        self.put("libdecomp/decomp/base/run.h", "#pragma once\n")
        self.assert_fault("wording", "no SPDX line")

    def test_an_unfinished_mark(self):
        self.put("libdecomp/decomp/base/run.h", SPDX + "// TO" + "DO later\n")
        self.assert_fault("wording", "run.h:2")

    def test_a_path_of_one_machine(self):
        self.put("README.md", "see /ho" + "me/somebody/models\n")
        self.assert_fault("wording", "no path of one machine")

    def test_a_file_that_has_grown_too_long(self):
        self.put("libdecomp/decomp/base/run.h", SPDX + "\n" * 700)
        self.assert_fault("wording", "701 lines")

    def test_code_that_is_commented_out(self):
        self.put("libdecomp/decomp/base/run.h", SPDX + "    // return walk(3);\n")
        self.assert_fault("wording", "commented out")

    def test_an_error_code_without_its_line(self):
        self.put("libdecomp/decomp/base/run.cpp", SPDX + 'auto e = fail(\n    "base.new",\n    "");\n')
        self.assert_fault("errors", "run.cpp:2: base.new is not in docs/errors.md")

    def test_a_line_without_its_error_code(self):
        self.put("docs/errors.md", ERRORS + "| `mesh.gone` | old | none |\n")
        self.assert_fault("errors", "no source says mesh.gone")


if __name__ == "__main__":
    unittest.main()
