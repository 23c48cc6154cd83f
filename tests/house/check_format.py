# SPDX-License-Identifier: GPL-3.0-or-later
"""Every C++ file is as clang-format leaves it."""

import re
import shutil
import subprocess
import sys

from house import ROOT, files, report

SKIPPED = 77


def main():
    program = shutil.which("clang-format-14") or shutil.which("clang-format")
    if program is None:
        print("clang-format is not installed")
        sys.exit(SKIPPED)
    sources = [str(f.relative_to(ROOT)) for f in files(".h", ".cpp", under=["libdecomp", "libcam", "tools", "tests"])]
    answer = subprocess.run([program, "--dry-run", *sources], cwd=ROOT, capture_output=True, text=True, check=False)
    wrong = sorted(set(re.findall(r"^(\S+?):\d+:\d+: warning", answer.stderr, re.M)))
    report("format", [f"{file}: run clang-format -i on it" for file in wrong])


main()
