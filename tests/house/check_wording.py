# SPDX-License-Identifier: GPL-3.0-or-later
"""Words, licence lines, lengths and literals that the house does not want."""

import re
import tomllib

from house import ROOT, files, line_of, report, without_comments

TEXT = {".h", ".cpp", ".py", ".sh", ".md", ".txt", ".cmake", ".toml", ".json", ".in", ""}
CODE = {".h", ".cpp", ".py", ".sh"}
LONGEST = 600
TINY = re.compile(r"(?<![\w.])\d*\.?\d*[eE]-\d+")
NAMED = re.compile(r"\bconstexpr\b[^=]*\bk[A-Z]\w*|^\s*(double|float)\s+\w+\s*=")
OLD_CODE = re.compile(r"^\s*//[^/].*[)\]};]\s*;\s*$|^\s*//\s*(if|for|while|return)\b.*[;{]\s*$")


def forbidden_words(file, text):
    for entry in tomllib.loads((ROOT / "tests/house/words.toml").read_text())["forbidden"]:
        for match in re.finditer(entry["pattern"], text):
            yield f"{file}:{line_of(text, match.start())}: '{match.group(0)}': {entry['reason']}"


def tiny_literals(file, text):
    """1e-9 and the like must have a name: constexpr kSomething, a member's default, or tolerance.h."""
    code = without_comments(text)
    for match in TINY.finditer(code):
        begin = max(code.rfind(";", 0, match.start()), code.rfind("{\n", 0, match.start()),
                    code.rfind("}\n", 0, match.start()))
        if not NAMED.search(code[begin + 1:match.start()]):
            yield f"{file}:{line_of(code, match.start())}: {match.group(0)}: give the tolerance a name (constexpr kSomething)"


def main():
    faults = []
    for path in files():
        file = path.relative_to(ROOT)
        if path.suffix not in TEXT or "corpus" in file.parts or "data" in file.parts or file.name == "words.toml":
            continue
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            faults.append(f"{file}: is not UTF-8 text")
            continue
        faults += forbidden_words(file, text)
        script = text.startswith("#!")
        if path.suffix in CODE or script:
            if "SPDX-License-Identifier: GPL-3.0-or-later" not in text[:200]:
                faults.append(f"{file}: no SPDX line at the top")
            if (lines := text.count("\n")) > LONGEST:
                faults.append(f"{file}: {lines} lines; split it (at most {LONGEST})")
        if path.suffix in {".h", ".cpp"}:
            faults += [f"{file}:{n}: code that is commented out" for n, line in enumerate(text.split("\n"), 1)
                       if OLD_CODE.match(line)]
            if file.parts[0] != "tests" and path.name != "tolerance.h":
                faults += tiny_literals(file, text)
    report("wording", faults)


main()
