#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Hew beside PrusaSlicer and CuraEngine on the same parts with the same settings: CPU, memory, wall, filament, time, and
# what Hew's checker says of each program.
#   tests/bench/slicers.sh BUILD_DIR CURA_DEFINITIONS PART.stl …
# CURA_DEFINITIONS is the folder resources/ of Debian's package cura (dpkg -x); '-' leaves CuraEngine out.
set -eu

build=$1
cura=$2
shift 2
hew=$build/tools/hew
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

same="--set process.first_layer_height_mm=0.2 --set process.first_layer_line_width_mm=0.45 --set process.top_layers=4
--set process.solid_speed_mm_per_s=50 --set process.bridge_speed_mm_per_s=40 --set process.support_angle_deg=${SUPPORT_ANGLE:-0}"

cat >"$out/prusa.ini" <<'INI'
bed_shape = -113.5x-74,113.5x-74,113.5x74,-113.5x74
max_print_height = 150
gcode_flavor = marlin
nozzle_diameter = 0.4
filament_diameter = 1.75
filament_density = 1.24
temperature = 210
first_layer_temperature = 215
bed_temperature = 60
first_layer_bed_temperature = 60
layer_height = 0.2
first_layer_height = 0.2
perimeters = 3
fill_density = 15%
fill_pattern = grid
top_solid_layers = 4
bottom_solid_layers = 4
skirts = 2
brim_width = 0
perimeter_speed = 45
external_perimeter_speed = 30
small_perimeter_speed = 30
infill_speed = 60
solid_infill_speed = 50
top_solid_infill_speed = 50
bridge_speed = 40
gap_fill_speed = 50
travel_speed = 120
first_layer_speed = 20
retract_length = 1.3
retract_speed = 25
extrusion_width = 0.45
first_layer_extrusion_width = 0.45
cooling = 1
slowdown_below_layer_time = 10
min_print_speed = 10
use_relative_e_distances = 1
thumbnails =
start_gcode = M140 S60\nM104 S215\nM190 S60\nM109 S215\nG28\nG92 E0
layer_gcode = G92 E0
end_gcode = M104 S0\nM140 S0
INI

cura_settings="machine_width=227 machine_depth=148 machine_height=150 machine_center_is_zero=true center_object=true
mesh_position_x=0 mesh_position_y=0 mesh_position_z=0 machine_heated_bed=true layer_height=0.2 layer_height_0=0.2
line_width=0.45 wall_line_width=0.45 wall_line_width_0=0.45 wall_line_width_x=0.45 skin_line_width=0.45
infill_line_width=0.45 skirt_brim_line_width=0.45 support_line_width=0.45 initial_layer_line_width_factor=100
wall_line_count=3 wall_thickness=1.35 top_layers=4 bottom_layers=4 initial_bottom_layers=4 top_thickness=0.8
bottom_thickness=0.8 infill_sparse_density=15 infill_pattern=grid infill_line_distance=6 speed_print=60 speed_wall=45
speed_wall_0=30 speed_wall_x=45 speed_infill=60 speed_topbottom=50 speed_travel=120 speed_layer_0=20
speed_print_layer_0=20 speed_travel_layer_0=60 skirt_brim_speed=20 material_print_temperature=210
material_print_temperature_layer_0=215 material_initial_print_temperature=210 material_final_print_temperature=210
material_bed_temperature=60 material_bed_temperature_layer_0=60 material_diameter=1.75 retraction_enable=true
retraction_amount=1.3 retraction_speed=25 retraction_retract_speed=25 retraction_prime_speed=25 cool_min_layer_time=10
cool_min_speed=10 adhesion_type=skirt skirt_line_count=2 roofing_layer_count=0 support_enable=false"

timed() { # NAME COMMAND …
    name=$1
    shift
    /usr/bin/time -f '%U %S %M %e' -o "$out/$name.time" "$@" >"$out/$name.log" 2>&1 || true
}

row() { # PART SLICER
    "$hew" verify "$out/$2.gcode" --part "$1" --machine flashforge-creator-pro $same --foreign --json \
        >"$out/proof.json" 2>/dev/null || true
    python3 - "$(basename "$1" .stl)" "$2" "$out" <<'PY'
import json
import re
import sys

part, slicer, out = sys.argv[1:]
user, system, peak, wall = open(f"{out}/{slicer}.time").read().split("\n")[-2].split()
try:
    figures = json.load(open(f"{out}/proof.json"))["figures"]
except (OSError, ValueError, KeyError):
    print(f"{part:<14} {slicer:<6} no program")
    sys.exit()
text = open(f"{out}/{slicer}.gcode", errors="replace").read() + open(f"{out}/{slicer}.log", errors="replace").read()
seconds = 0
if m := re.search(r"estimated printing time[^=]*= *(.*)", text):
    for number, unit in re.findall(r"(\d+)([dhms])", m[1]):
        seconds += int(number) * {"d": 86400, "h": 3600, "m": 60, "s": 1}[unit]
elif m := re.search(r"Print time \(s\): (\d+)", text):
    seconds = int(m[1])
print(f"{part:<14} {slicer:<6} {float(user) + float(system):7.2f} {int(peak) // 1024:5d} {float(wall):7.1f}"
      f" {figures['filament_mm']:9.0f} {seconds / 60:7.0f} {figures['solid_fill_ratio']:6.3f}"
      f" {figures['uncovered_skin_percent']:9.4f} {figures['out_of_part_percent']:9.4f}"
      f" {figures['floating_islands']:4d} {figures['moves_outside_chamber']:4d} {figures['layers']:5d}")
PY
}

echo "part           slicer   CPU s    MB  wall s  filament min est   fill  uncov. %     out % isl. out. layers"
for part in "$@"; do
    if [ -x "$build/tests/bench/hew_slice_cpu" ]; then # without repair and proof: built with HEW_BUILD_BENCH
        timed hew "$build/tests/bench/hew_slice_cpu" "$part" flashforge-creator-pro "$out/hew.gcode" \
            $(echo "$same" | sed 's/--set//g')
        row "$part" hew
    fi
    timed whole "$hew" slice "$part" --machine flashforge-creator-pro $same -o "$out/whole.gcode" --jobs 2 -q
    row "$part" whole
    timed prusa prusa-slicer --loglevel 1 --load "$out/prusa.ini" --center 0,0 --export-gcode \
        --output "$out/prusa.gcode" "$part"
    row "$part" prusa
    if [ "$cura" != - ]; then
        export CURA_ENGINE_SEARCH_PATH="$cura/definitions:$cura/extruders"
        options=$(for s in $cura_settings; do echo "-s $s"; done)
        timed cura CuraEngine slice -v -j "$cura/definitions/fdmprinter.def.json" $options -e0 -s extruder_nr=0 \
            -s machine_nozzle_size=0.4 -s material_diameter=1.75 -l "$part" -o "$out/cura.gcode"
        row "$part" cura
    fi
    rm -f "$out"/*.gcode
done
