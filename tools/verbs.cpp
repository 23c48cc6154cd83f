// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/verb.h"

namespace tools {

namespace {

constexpr Verb kVerbs[] = {
    {"make", "From a shape to programs",
     "cut a shape into parts and write a proved program for every plate",
     "  hew make statue.stl --machine flashforge-creator-pro --up y --height 245mm -o out/\n"
     "  hew make statue.stl --machine prusa-mk3s --material petg --set "
     "process.layer_height_mm=0.15 -o out/\n"
     "  hew make statue.stl --machine prusa-mk3s -o out/ --dry-run      what would be done, "
     "writing nothing\n"
     "An interrupted make run again continues where it stood.",
     declare_make},
    {"decompose", "From a shape to programs",
     "cut a shape into parts that fit the machine, and stop there",
     "  hew decompose statue.stl --machine prusa-mk3s --height 60cm -o out/\n"
     "  hew make statue.stl --machine prusa-mk3s --height 60cm -o out/  continues from there\n"
     "  hew decompose statue.stl --machine prusa-mk3s -o mine/ --split P03:z=0.5 --merge P01+P02\n"
     "  hew decompose statue.stl --machine prusa-mk3s -o mine/ --plan out/plan.toml",
     declare_decompose},
    {"export", "From a shape to programs",
     "write the parts of a job as STEP solids, for other programs",
     "  hew export out/ --step\n"
     "  hew export out/ --step --step-tol 0.02mm --step-schema ap242",
     declare_export},
    {"polycube", "From a shape to programs", "make the polycube of a shape, or check one",
     "  hew polycube statue.stl -o pair/\n"
     "  hew polycube statue.stl --target-parts 9 -o pair/\n"
     "  hew polycube --check pair/\n"
     "  hew polycube --check shape.mesh polycube.mesh",
     declare_polycube},
    {"slice", "From a shape to programs",
     "write the program of one part of a job, or of a lone mesh",
     "  hew slice out/ --part P03\n"
     "  hew slice part.stl --machine prusa-mk3s -o part.gcode",
     declare_slice},
    {"mill", "From a shape to programs",
     "write the milling programs of one part, with a set-up sheet",
     "  hew mill part.stl --machine linuxcnc-router-3axis --material pine -o p.ngc\n"
     "  hew mill part.stl --machine shapeoko-4 --stock 120x100x40mm --tools flat-6,ball-3 -o "
     "p.nc\n"
     "  hew mill out/ --part P02 --machine linuxcnc-router-3axis --setups 2 -o P02.ngc",
     declare_mill},
    {"verify", "Looking", "prove a program against the part that it should make",
     "  hew verify part.gcode --part part.stl --machine prusa-mk3s\n"
     "  hew verify out/                                                 all plates of a job\n"
     "  hew verify cube.gcode --part cube.stl --machine prusa-mk3s --foreign",
     declare_verify},
    {"inspect", "Looking", "measure a mesh and say what is wrong with it",
     "  hew inspect statue.stl\n"
     "  hew inspect statue.obj --unit cm --json",
     declare_inspect},
    {"check", "Looking", "say whether parts can be made by a process, how best, and why not",
     "  hew check out/ --process fdm --machine prusa-mk3s\n"
     "  hew check bust.stl --process fdm -o pictures/\n"
     "  hew check out/ --process mill3 --machine genmitsu-3018 --setups 2\n"
     "  hew check bust.stl --process mill4 --tool ball-3 --tool ball-6 -o pictures/\n"
     "  hew check bust.stl --process mill4 --axis 0,0,1 --drop-unreachable millable/",
     declare_check},
    {"render", "Looking", "draw a mesh, the parts of a job, or the layers of a part",
     "  hew render statue.stl -o statue.png\n"
     "  hew render out/ -o parts.png --explode 0.3 --view iso",
     declare_render},
    {"machines", "Machines", "list the machine profiles, or explain one",
     "  hew machines\n"
     "  hew machines show prusa-mk3s",
     declare_machines},
    {"stream", "Machines", "run a proved program on a machine over its serial port",
     "  hew stream out/ --port /dev/ttyACM0\n"
     "  hew stream out/ --plate plate-2 --resume                        where it stood\n"
     "  hew stream part.nc --machine genmitsu-3018 --foreign --port auto\n"
     "  hew stream out/ --link virtual-marlin --port printer            with 'hew sim marlin "
     "--pty "
     "printer'\n"
     "This is no safety function: the machine needs an emergency stop of its own.",
     declare_stream},
    {"ports", "Machines", "list the serial ports",
     "  hew ports\n"
     "  hew ports --json",
     declare_ports},
    {"sim", "Machines", "a virtual printer or mill at a pseudo-terminal, to try streaming on",
     "  hew sim marlin --pty printer --baud 115200\n"
     "  hew sim grbl --pty mill --faults faults.txt\n"
     "  hew sim replay --log session.log --pty machine",
     declare_sim},
    {"demo", "Machines", "write a statue that is larger than most printers, to try things on",
     "  hew demo statue.stl", declare_demo},
};

}  // namespace

std::span<const Verb> verbs() { return kVerbs; }

}  // namespace tools
