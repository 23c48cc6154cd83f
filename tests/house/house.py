# SPDX-License-Identifier: GPL-3.0-or-later
"""What the house checks share: the files of the tree, and C++ without its comments."""

import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOP = ["CMakeLists.txt", "CMakePresets.json", "README.md", "cmake", "docs", "libdecomp", "libcam", "machine_profiles",
       "tests", "tools", ".ci"]


def files(*suffixes, under=None):
    """Files of the tree with one of these suffixes (all, without suffixes), sorted; build folders are passed over."""
    found = []
    for top in under or TOP:
        start = ROOT / top
        if start.is_file():
            found.append(start)
        for folder, folders, names in os.walk(start):
            folders[:] = sorted(f for f in folders if not f.startswith("build") and f != "__pycache__")
            found += [Path(folder) / name for name in sorted(names)]
    return [f for f in found if not suffixes or f.suffix in suffixes]


def without_comments(text):
    """C++ with comments blanked out, line numbers kept; string literals stay."""
    def blank(match):
        piece = match.group(0)
        return piece if piece[0] in "\"'" else re.sub(r"[^\n]", " ", piece)
    literal = r"R\"\((?:.|\n)*?\)\"|\"(?:\\.|[^\"\\\n])*\"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'"
    return re.sub(literal + r"|//[^\n]*|/\*(?:.|\n)*?\*/", lambda m: m.group(0) if m.group(0)[0] == "R" else blank(m),
                  text)


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def report(name, faults):
    for fault in faults:
        print(fault)
    print(f"{name}: {len(faults)} faults")
    sys.exit(1 if faults else 0)
