#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Cuts the models of HEW_MODELS in every mode, carries out each plan.toml again in another directory, and compares all
# files but job.json (whose options differ) and timings.json. One line each: model, mode, tier, parts, steps, seconds of
# the parts stage when searched and when carried out, "same" or the first file that differs.
# Usage: plan_replay.sh HEW [MODEL...]
set -u
hew=$1
shift
models=("$@")
[ ${#models[@]} -gt 0 ] || models=("$HEW_MODELS"/paper/*)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
seconds() { python3 -c 'import json,sys
for s in json.load(open(sys.argv[1]))["stages"]:
    if s["name"] == "parts": print(s["wall_s"])' "$1/timings.json"; }
for model in "${models[@]}"; do
    for mode in "sections" "paper --boxes" "sheets --boxes"; do
        rm -rf "$scratch/one" "$scratch/two"
        words=("$model" --machine flashforge-creator-pro --height 200mm -q)
        # shellcheck disable=SC2086
        if ! "$hew" decompose "${words[@]}" --mode $mode -o "$scratch/one" 2> "$scratch/error"; then
            echo "$(basename "$model") ${mode%% *}: $(head -1 "$scratch/error")"
            continue
        fi
        if ! "$hew" decompose "${words[@]}" --plan "$scratch/one/plan.toml" -o "$scratch/two" 2> "$scratch/error"; then
            echo "$(basename "$model") ${mode%% *}: NOT CARRIED OUT: $(head -1 "$scratch/error")"
            continue
        fi
        differs=$(diff -rq -x job.json -x timings.json "$scratch/one" "$scratch/two" | head -1)
        echo "$(basename "$model") ${mode%% *} $(sed -n 's/^tier = //p' "$scratch/one/plan.toml")" \
            "$(ls "$scratch"/one/parts/*.ply | wc -l) parts $(grep -c '^\[\[step' "$scratch/one/plan.toml") steps" \
            "$(seconds "$scratch/one") s, $(seconds "$scratch/two") s: ${differs:-same}"
    done
done
