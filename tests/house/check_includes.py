# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the includes of libdecomp and libcam to tests/house/rooms.toml: edges between rooms, cycles, third parties."""

import re
import tomllib

from house import ROOT, files, line_of, report, without_comments

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)
POSIX = re.compile(r"^(unistd|fcntl|spawn|signal|dlfcn|sys/\w+)(\.h)?$")
EVERYWHERE = {"std", "Eigen", "tl"}


def third_party(name):
    """The party that an angle include belongs to: its folder, or its name without suffix; "std" and "posix"."""
    if POSIX.match(name):
        return "posix"
    if "/" in name:
        return name.split("/")[0]
    if name.endswith(".hxx"):
        return "OCCT"
    return name.removesuffix(".h") if name.endswith(".h") else "std"


def cycle(edges):
    """A list of rooms that see each other in a circle, or None."""
    done, path = set(), []

    def visit(room):
        if room in path:
            return path[path.index(room):] + [room]
        if room in done:
            return None
        path.append(room)
        for other in sorted(edges.get(room, ())):
            if found := visit(other):
                return found
        path.pop()
        done.add(room)
        return None

    for room in sorted(edges):
        if found := visit(room):
            return found
    return None


def main():
    table = tomllib.loads((ROOT / "tests/house/rooms.toml").read_text())["rooms"]
    faults = []
    if found := cycle({room: entry["rooms"] for room, entry in table.items()}):
        faults.append("rooms.toml: a cycle: " + " -> ".join(found))
    for file in files(".h", ".cpp", under=["libdecomp", "libcam"]):
        _, library, folder, *rest = file.relative_to(ROOT).parts
        room = f"{library}.{folder}"
        where = file.relative_to(ROOT)
        if room not in table:
            faults.append(f"{where}: room {room} is not in rooms.toml")
            continue
        public = file.suffix == ".h" and not file.stem.endswith("_detail")
        allowed = set(table[room].get("third_parties", {}).get("/".join(rest), []))
        if public and allowed:
            faults.append(f"rooms.toml: {where} is a public header and may not include third parties")
        text = without_comments(file.read_text())
        for match in INCLUDE.finditer(text):
            place = f"{where}:{line_of(text, match.start())}"
            quoted, name = match.group(1) == '"', match.group(2)
            if not quoted:
                party = third_party(name)
                if party not in EVERYWHERE and party not in allowed:
                    faults.append(f"{place}: <{name}>: rooms.toml does not list {party} for this file")
                continue
            parts = name.split("/")
            if len(parts) < 3 or parts[0] not in ("decomp", "cam"):
                faults.append(f'{place}: "{name}": write the path from the library, "decomp/mesh/tri_mesh.h"')
                continue
            other = f"{parts[0]}.{parts[1]}"
            if other != room and other not in table[room]["rooms"]:
                faults.append(f"{place}: {room} may not include {other} (rooms.toml)")
            if other != room and parts[-1].endswith("_detail.h"):
                faults.append(f"{place}: {parts[-1]} is private to {other}")
            if public and parts[-1].endswith("_detail.h"):
                faults.append(f"{place}: a public header includes the private {parts[-1]}")
    for room, entry in table.items():
        for file in entry.get("third_parties", {}):
            if not (ROOT / f"lib{room.split('.')[0]}" / room.replace(".", "/") / file).exists():
                faults.append(f"rooms.toml: {room} lists {file}, which is not there")
    report("includes", faults)


main()
