#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What `hew check` says of real meshes: overhang over six axes, and what rays and balls reach about the axis that it
# finds; pictures into a folder.
#   HEW_MODELS=… tests/bench/check_tables.sh [build/release/tools/hew] [pictures]
# Cost figures: build with HEW_BUILD_BENCH=ON, then HEW_MODELS=… build/release/tests/bench/check_bench
set -eu

hew=${1:-build/release/tools/hew}
pictures=${2:-}
: "${HEW_MODELS:?say where the models are}"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

echo "overhang, percent of the whole model's area (up is the file's axis)"
printf '%-12s %6s %6s %6s %6s %6s %6s\n' model z -z x -x y -y
for model in hfd_maxplank.obj hfd_BU.obj av_duck.mesh av_angel1.mesh av_moai.mesh; do
    "$hew" check "$HEW_MODELS/paper/$model" --process fdm --height 100mm --json -q >"$out/json" 2>/dev/null || :
    python3 - "$model" "$out/json" <<'PY'
import json
import sys

axes = json.load(open(sys.argv[2]))["whole"]["axes"]
print(f"{sys.argv[1].split('.')[0]:<12} " + " ".join(f"{a['overhang']['by_area_percent']:6.2f}" for a in axes))
PY
done

echo
echo "reach about the axis found, longest side 66 mm, percent of area; indices: A (percent covered after it)"
for model in "hfd_BU.obj x 66" "hfd_maxplank.obj y 66"; do
    # shellcheck disable=SC2086
    set -- $model
    draw=${pictures:+-o $pictures/ball-3}
    # shellcheck disable=SC2086
    "$hew" check "$HEW_MODELS/paper/$1" --process mill4 --up "$2" --height "$3mm" --tool ball-3 --tool ball-6 --json -q \
        --jobs 1 --force $draw >"$out/json" 2>/dev/null || :
    python3 - "$1" "$out/json" <<'PY'
import json
import sys

part = json.load(open(sys.argv[2]))["parts"][0]
share = lambda s: s["by_area_percent"]
cover = lambda i: " ".join(f"{a:g} ({c:.1f})" for a, c in zip(i["a_deg"], i["covered_percent"])) + (
    "" if i["proved_smallest"] else f" not proved smallest: at least {i['at_least']}")
axis = " ".join(f"{x:.3f}" for x in part["axis"])
print(f"{sys.argv[1].split('.')[0]}: axis {axis}, ends {share(part['ends']):.2f}")
print(f"  {'ray':<8} unreached {share(part['unseen']):6.2f}   {cover(part['indices'])}")
for t in part["tools"]:
    print(f"  {t['tool']:<8} unreached {share(t['unreached']):6.2f}   {cover(t['indices'])}   "
          f"at the ray's indices {share(t['unreached_at_indices']):.2f}, cutter alone "
          f"{share(t['unreached_by_cutter_alone']):.2f}")
PY
    if [ -n "$pictures" ]; then
        "$hew" check "$HEW_MODELS/paper/$1" --process mill4 --up "$2" --height "$3mm" --force -q \
            -o "$pictures/ray" >/dev/null 2>&1 || :
        "$hew" check "$HEW_MODELS/paper/$1" --process mill4 --up "$2" --height "$3mm" --tool ball-6 --force -q \
            --jobs 2 -o "$pictures/ball-6" >/dev/null 2>&1 || :
    fi
done
