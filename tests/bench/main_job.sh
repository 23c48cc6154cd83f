#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The main job on real meshes, one row each: wall and CPU seconds, peak memory, parts, plates, proof.
#   HEW_MODELS=… tests/bench/main_job.sh [build/release/tools/hew]
set -eu

hew=${1:-build/release/tools/hew}
: "${HEW_MODELS:?say where the models are}"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

row() {
    name=$1
    shift
    status=0
    /usr/bin/time -f '%e %U %M' -o "$out/time" "$hew" make "$@" --machine flashforge-creator-pro -o "$out/$name" \
        --jobs 2 -q >/dev/null 2>"$out/log" || status=$?
    python3 - "$name" "$status" "$out/time" "$out/$name/report.json" <<'PY'
import json
import sys

name, status, time_file, report_file = sys.argv[1:]
wall, cpu, peak = open(time_file).read().split("\n")[-2].split()
totals = json.load(open(report_file))["totals"]
print(f"{name:<12} {float(wall):8.1f} {float(cpu):8.1f} {int(peak) // 1024:8d} {totals['parts']:6d} {totals['plates']:7d}"
      f"  {'proved' if totals['passed'] else 'NOT PROVED'} (exit {status})")
PY
}

echo "model          wall s    CPU s  peak MB  parts  plates"
row max-planck "$HEW_MODELS/paper/hfd_maxplank.obj" --up y --height 245mm
row bu "$HEW_MODELS/paper/hfd_BU.obj" --up x --height 300mm
row plate-holes "$HEW_MODELS/real/tm_plate_holes.stl"
row nefertiti "$HEW_MODELS/real/od_nefertiti_lr.obj" --up y --height 400mm
"$hew" demo "$out/statue.stl" -q
row statue "$out/statue.stl"
