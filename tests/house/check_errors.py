# SPDX-License-Identifier: GPL-3.0-or-later
"""Every error code in the sources has its line in docs/errors.md, and the other way round."""

import re

from house import ROOT, files, line_of, report, without_comments

RAISED = re.compile(r'\b(?:fail|Error)\s*[({]\s*"([^"]*)"')
CODE = re.compile(r"^[a-z][a-z0-9_]*(\.[a-z0-9_]+)+$")
ROW = re.compile(r"^\| `([^`]+)` \| ([^|]*) \| ([^|]*) \|$", re.M)


def main():
    page = (ROOT / "docs/errors.md").read_text()
    listed, faults = {}, []
    for match in ROW.finditer(page):
        code = match.group(1)
        if code in listed:
            faults.append(f"docs/errors.md: {code} stands twice")
        if not match.group(2).strip() or not match.group(3).strip():
            faults.append(f"docs/errors.md: {code} lacks its meaning or what to try")
        listed[code] = match
    for line in page.split("\n"):
        if line.startswith("| `") and not ROW.match(line):
            faults.append(f"docs/errors.md: not three columns: {line}")
    sources = ""
    for path in files(".h", ".cpp", under=["libdecomp", "libcam", "tools"]):
        text = without_comments(path.read_text())
        sources += text
        for match in RAISED.finditer(text):
            code, where = match.group(1), f"{path.relative_to(ROOT)}:{line_of(text, match.start())}"
            if not CODE.match(code):
                faults.append(f"{where}: '{code}' is not a dotted code")
            elif code not in listed:
                faults.append(f"{where}: {code} is not in docs/errors.md")
    faults += [f"docs/errors.md: no source says {code}" for code in listed if f'"{code}"' not in sources]
    report("errors", faults)


main()
