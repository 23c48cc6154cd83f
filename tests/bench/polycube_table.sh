#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Polycubes of real models, one row each: tier as checked from the files, charts, corners, turning points, flips,
# flipped volume, mean symmetric Dirichlet energy, fidelity, blocks, CPU seconds, peak memory. Further arguments go to
# `hew polycube`: --plain (no deformed starts), --starts 1, --label-repair deletion.
#   HEW_MODELS=… tests/bench/polycube_table.sh [build/release/tools/hew [OPTION …]]
set -eu

hew=${1:-build/release/tools/hew}
[ $# -gt 0 ] && shift
: "${HEW_MODELS:?say where the models are}"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

row() {
    name=$1
    model=$2
    compactness=$3
    shift 3
    status=0
    /usr/bin/time -f '%U %S %M' -o "$out/time" "$hew" polycube "$HEW_MODELS/$model" --compactness "$compactness" \
        -o "$out/$name" --json -q "$@" >"$out/json" 2>"$out/log" || status=$?
    python3 - "$name" "$compactness" "$status" "$out/time" "$out/json" <<'PY'
import json
import sys

name, compactness, status, time_file, json_file = sys.argv[1:]
if status != "0":
    print(f"{name:<10} failed with exit code {status}")
    sys.exit()
user, system, peak = open(time_file).read().split("\n")[-2].split()
answer = json.load(open(json_file))
made, checked = answer["made"], answer["checked"]
print(f"{name:<10} {compactness:>3} {checked['tier']} {made['charts']:6d} {made['corners']:7d} {made['turning_points']:3d} "
      f"{checked['flips']:5d} {checked['flipped_percent']:8.4f} {made['symmetric_dirichlet']:9.3f} {made['fidelity']:8.3f} "
      f"{made['cells']:6d} {float(user) + float(system):6.1f} {int(peak) // 1024:7d}  {made['start']}")
PY
}

echo "model        c tier charts corners  tp flips  flipped% dirichlet fidelity blocks  CPU s peak MB  start"
row max-planck paper/hfd_maxplank.obj 7 "$@"
row hole3 paper/cinolib_3holes.obj 3 "$@"
row duck paper/av_duck.mesh 5 "$@"
row angel paper/av_angel1.mesh 5 "$@"
row moai paper/av_moai.mesh 3 "$@"
row fandisk paper/av_fandisk.mesh 4 "$@"
row bu paper/hfd_BU.obj 9 "$@"
row spot real/od_spot.obj 5 "$@"
row hammer real/od_hammer.obj 5 "$@"
row plate real/tm_plate_holes.stl 5 "$@"
row chamfer real/av_chamfer.mesh 5 "$@"
row nefertiti real/od_nefertiti_lr.obj 5 "$@"
