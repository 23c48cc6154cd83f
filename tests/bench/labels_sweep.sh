#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Labels alone, as tables: all models; without repair and with deletion; shapes with handles; inputs of several
# resolutions; compactness 1 to 10.
#   HEW_MODELS=… tests/bench/labels_sweep.sh [build/release/tests/bench/labels_table]
set -eu

table=${1:-build/release/tests/bench/labels_table}
: "${HEW_MODELS:?say where the models are}"

echo "== all models, compactness of the paper where it has one"
"$table" --compactness 0
for mode in none deletion; do
    echo "== repair: $mode"
    "$table" --compactness 0 --repair "$mode"
done
echo "== shapes with handles"
"$table" --handles
echo "== resolution"
for n in 7000 25000 0; do
    "$table" --compactness 9 --input "$n" "$HEW_MODELS/paper/hfd_BU.obj"
done
for n in 5000 10000 0; do
    "$table" --compactness 3 --input "$n" "$HEW_MODELS/paper/av_moai.mesh"
done
echo "== compactness"
for model in paper/hfd_BU.obj paper/av_moai.mesh paper/av_fandisk.mesh real/od_spot.obj; do
    "$table" --compactness 1,2,3,4,5,6,7,8,9,10 "$HEW_MODELS/$model"
done
