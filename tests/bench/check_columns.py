#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The columns of `hew check` on a job, recomputed from its parts' files by the bare formulas.

    tests/bench/check_columns.py JOB [build/release/tools/hew]

Normals only for printing and three axes; for a rotary axis some facets of each part, every triangle against every
ray. Nothing is shared with the program but the files. Exit 1 when a figure differs.
"""
import json
import math
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

job = Path(sys.argv[1])
hew = sys.argv[2] if len(sys.argv) > 2 else "build/release/tools/hew"
PLATE_MM = 0.02
COS_SUPPORT = math.cos(math.radians(45))
UNDERCUT = 1e-6
END_COSINE = 0.99
SIZES = {"double": "d", "float": "f", "int": "i", "uint": "I", "uchar": "B", "char": "b", "short": "h", "ushort": "H"}
failures = 0


def read_ply(path):
    """Points, triangles and each triangle's properties."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    elements = []
    for line in data[:end].decode().splitlines():
        words = line.split()
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    points, triangles, rows, at = [], [], [], end
    for name, count, properties in elements:
        for _ in range(count):
            row = {}
            for prop in properties:
                if prop[0] == "list":
                    n = struct.unpack_from("<" + SIZES[prop[1]], data, at)[0]
                    at += struct.calcsize(SIZES[prop[1]])
                    row[prop[3]] = struct.unpack_from(f"<{n}{SIZES[prop[2]]}", data, at)
                    at += n * struct.calcsize(SIZES[prop[2]])
                else:
                    row[prop[1]] = struct.unpack_from("<" + SIZES[prop[0]], data, at)[0]
                    at += struct.calcsize(SIZES[prop[0]])
            if name == "vertex":
                points.append((row["x"], row["y"], row["z"]))
            elif name == "face":
                triangles.append(row.get("vertex_indices") or row["vertex_index"])
                rows.append(row)
    return points, triangles, rows


def sub(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def facets_of(points, triangles):
    """Corners, unit normal, area."""
    out = []
    for t in triangles:
        a, b, c = (points[v] for v in t)
        n = cross(sub(b, a), sub(c, a))
        length = math.sqrt(dot(n, n))
        out.append(((a, b, c), tuple(x / length for x in n) if length else (0, 0, 0), length / 2))
    return out


def leaning(facets, down, cosine, cut_plate):
    """Percent of area that faces `down` by more than `cosine`; what lies on the plate or table does not count."""
    low = max(dot(p, down) for corners, _, _ in facets for p in corners)
    total = sum(area for _, _, area in facets)
    over = 0
    for corners, normal, area in facets:
        on_plate = all(low - dot(p, down) <= cut_plate for p in corners)
        if dot(normal, down) > cosine and not on_plate:
            over += area
    return 100 * over / total


def expect(what, told, found, within=1e-3):
    global failures
    same = abs(told - found) <= within
    failures += not same
    print(f"{'ok  ' if same else 'DIFF'} {what:<34} told {told:9.4f}  found {found:9.4f}")


def check(process, *more):
    run = subprocess.run([hew, "check", str(job), "--process", process, "--json", "-q", *more], capture_output=True,
                         text=True, check=False)
    return json.loads(run.stdout)


parts = {path.stem: facets_of(*read_ply(path)[:2]) for path in sorted((job / "parts").glob("*.ply"))}
areas = {name: sum(f[2] for f in facets) for name, facets in parts.items()}

fdm = check("fdm")
model = facets_of(*read_ply(job / "model.ply")[:2])
for axis in fdm["whole"]["axes"]:
    expect(f"whole %3DPST up {axis['up']}", axis["overhang"]["by_area_percent"],
           leaning(model, axis["down"], COS_SUPPORT, PLATE_MM))
over = 0
for part in fdm["parts"]:
    down = part["best"]["down"]
    expect(f"{part['id']} area_mm2", part["area_mm2"], areas[part["id"]], 1e-6 * areas[part["id"]])
    found = leaning(parts[part["id"]], down, COS_SUPPORT, PLATE_MM)
    expect(f"{part['id']} overhang on its base", part["best"]["overhang"]["by_area_percent"], found)
    over += part["3DPPS"]["paper_percent"] / 100 * areas[part["id"]]
expect("%3DPPST of the parts' area", fdm["3DPPST"]["paper_percent"], 100 * over / sum(areas.values()))

mill3 = check("mill3")
for part in mill3["parts"]:
    down = [-x for x in part["direction"]]
    expect(f"{part['id']} undercut (%3AM, paper)", part["undercut"]["by_area_percent"],
           leaning(parts[part["id"]], down, UNDERCUT, PLATE_MM))
told = sum(p["3AM"]["paper_percent"] * p["area_mm2"] for p in mill3["parts"]) / sum(areas.values())
expect("%3AM of all parts", mill3["3AM"]["paper_percent"], told)


def meets(facets, origin, d):
    for corners, _, _ in facets:
        a, b, c = (sub(p, origin) for p in corners)
        ab, bc, ca = dot(d, cross(a, b)), dot(d, cross(b, c)), dot(d, cross(c, a))
        if (ab >= 0 and bc >= 0 and ca >= 0) or (ab <= 0 and bc <= 0 and ca <= 0):
            n = cross(sub(b, a), sub(c, a))
            if dot(n, d) and dot(a, n) / dot(n, d) > 0:
                return True
    return False


END, UNSEEN = (150, 160, 178), (214, 64, 52)
with tempfile.TemporaryDirectory() as out:
    mill4 = check("mill4", "-o", out)
    for part in mill4["parts"]:
        facets = parts[part["id"]]
        axis = part["axis"]
        expect(f"{part['id']} ends", part["ends"]["by_area_percent"],
               100 * sum(a for _, n, a in facets if abs(dot(n, axis)) > END_COSINE) / areas[part["id"]])
        colours = [(r["red"], r["green"], r["blue"]) for r in read_ply(Path(out) / (part["id"] + ".ply"))[2]]
        unseen = [i for i, colour in enumerate(colours) if colour == UNSEEN]
        expect(f"{part['id']} %4AM by facets", part["4AM"]["paper_percent"], 100 * len(unseen) / len(facets))
        expect(f"{part['id']} %4AM by area", part["4AM"]["true_percent"],
               100 * sum(facets[i][2] for i in unseen) / areas[part["id"]])
        m = part["setup_from_model"]
        side, up = m[4:7], m[8:11]
        diagonal = math.dist([min(p[k] for f in facets for p in f[0]) for k in range(3)],
                             [max(p[k] for f in facets for p in f[0]) for k in range(3)])
        rng = random.Random(1)
        some = rng.sample(unseen, min(4, len(unseen))) + rng.sample(range(len(facets)), 12)
        differ = 0
        for i in some:
            corners, n, _ = facets[i]
            origin = tuple(sum(p[k] for p in corners) / 3 + 1e-5 * diagonal * n[k] for k in range(3))
            turns = [2 * math.pi * j / 40 for j in range(40)]
            directions = [tuple(math.cos(t) * up[k] - math.sin(t) * side[k] for k in range(3)) for t in turns]
            facing = sorted((d for d in directions if dot(d, n) > 0), key=lambda d: -dot(d, n))
            seen = any(not meets(facets, origin, d) for d in facing)
            differ += colours[i] != END and seen == (colours[i] == UNSEEN)
        expect(f"{part['id']} rays of {len(some)} facets differ", 0, differ)

sys.exit(1 if failures else 0)
