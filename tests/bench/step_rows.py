# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of step.sh: NAME JOB_DIRECTORY SCRATCH_DIRECTORY."""
import json
import sys
from pathlib import Path

name, job, scratch = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
parts = {p["id"]: p for p in json.load(open(job / "job.json"))["parts"]}
judged = {j["file"]: j for j in (json.loads(line[7:]) for line in open(scratch / "judged"))}
cpu = open(scratch / "time").read().split()[-1]
for row in json.load(open(scratch / "export.json"))["parts"]:
    to_solid, to_part = open(scratch / f"{name}.{row['id']}.dev").read().split()
    part, judge = parts[row["id"]], judged.get(row["id"] + ".step")
    verdict = "not read"
    if judge:
        sound = "valid" if judge["valid"] and judge["closed"] else "FAULTY"
        change = (judge["volume_mm3"] - part["volume_mm3"]) / part["volume_mm3"]
        verdict = f"{judge['type']} {sound} {change:9.1e} {judge['cpu_s']:7.1f}"
    print(f"{name:<12} {row['id']:<5} {part['triangles']:9d} {row['faces']:6d} {row['cylinders']:4d} {row['cones']:5d} {row['tori']:4d} "
          f"{row['bytes'] // 1000:6d} {to_solid:>9} {to_part:>8} {cpu:>12}  {verdict}", flush=True)
