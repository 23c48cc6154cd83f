#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The parts of real models as STEP solids, one row each: triangles of the part, faces, bytes, largest distance both ways
# over a million samples, CPU seconds to write all parts of the job, and what FreeCAD makes of the file (type, valid and
# closed, volume against the part's, CPU seconds to open it).
#   HEW_MODELS=… tests/bench/step.sh [build/release]        the build needs HEW_BUILD_BENCH=ON
#   STEP_TOL=0.05mm STEP_SAMPLES=1000000                    may be set
set -eu

build=${1:-build/release}
: "${HEW_MODELS:?say where the models are}"
tol=${STEP_TOL:-0.05mm}
samples=${STEP_SAMPLES:-1000000}
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

row() {
    name=$1
    shift
    job=$out/$name
    "$build/tools/hew" decompose "$@" --machine flashforge-creator-pro -o "$job" -q 2>"$out/log" || {
        echo "$name: not decomposed: $(tail -n 1 "$out/log")"
        return 0
    }
    /usr/bin/time -f '%U' -o "$out/time" "$build/tools/hew" export "$job" --step --step-tol "$tol" --json \
        >"$out/export.json" 2>"$out/log" || {
        python3 -c 'import json,sys; print(sys.argv[1] + ": refused:", json.load(open(sys.argv[2]))["error"]["message"])' \
            "$name" "$out/export.json"
        return 0
    }
    HEW_STEP_FILES=$(find "$job/step" -name 'P*.step' | sort) freecadcmd "$here/../support/judge_step.py" \
        </dev/null 2>/dev/null | grep '^judged ' >"$out/judged" || true
    for part in $(cd "$job/step" && find . -name 'P*.step' | sed 's,./,,; s,.step,,' | sort); do
        "$build/tests/bench/step_deviation" "$job/parts/$part.stl" "$job/step/$part.step" "$samples" \
            >"$out/$name.$part.dev"
    done
    python3 "$here/step_rows.py" "$name" "$job" "$out"
}

echo "model        part  triangles  faces  cyl cones tori     kB  to solid  to part  write CPU s  FreeCAD      dV/V   open s"
row max-planck "$HEW_MODELS/paper/hfd_maxplank.obj" --up y --height 245mm
row bu "$HEW_MODELS/paper/hfd_BU.obj" --up x --height 300mm
row angel "$HEW_MODELS/paper/av_angel1.mesh" --height 250mm
row duck "$HEW_MODELS/paper/av_duck.mesh" --height 200mm
row moai "$HEW_MODELS/paper/av_moai.mesh" --up y --height 250mm
row fandisk "$HEW_MODELS/paper/av_fandisk.mesh" --height 150mm
row hole3 "$HEW_MODELS/paper/cinolib_3holes.obj" --height 100mm
row spot "$HEW_MODELS/real/od_spot.obj" --up y --height 250mm
row hammer "$HEW_MODELS/real/od_hammer.obj" --height 250mm
row plate-holes "$HEW_MODELS/real/tm_plate_holes.stl"
row chamfer "$HEW_MODELS/real/av_chamfer.mesh" --height 150mm
row nefertiti "$HEW_MODELS/real/od_nefertiti_lr.obj" --up y --height 400mm
