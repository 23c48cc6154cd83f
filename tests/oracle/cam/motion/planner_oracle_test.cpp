// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/motion/planner.h"
#include "decomp/base/file.h"
#include "decomp/io/write_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <sstream>

namespace {

using Eigen::Vector4d;

/// The limits of one machine, told to PrusaSlicer and to our planner.
constexpr const char* kSlicerConfig = R"(bed_shape = 0x0,250x0,250x210,0x210
gcode_flavor = marlin
nozzle_diameter = 0.4
filament_diameter = 1.75
layer_height = 0.2
first_layer_height = 0.2
perimeters = 3
fill_density = 15%
perimeter_speed = 45
external_perimeter_speed = 30
infill_speed = 80
travel_speed = 150
retract_length = 0.8
retract_speed = 35
retract_lift = 0.2
cooling = 0
use_relative_e_distances = 1
layer_gcode = G92 E0
default_acceleration = 0
machine_limits_usage = time_estimate_only
machine_max_feedrate_x = 200
machine_max_feedrate_y = 200
machine_max_feedrate_z = 12
machine_max_feedrate_e = 120
machine_max_acceleration_x = 1000
machine_max_acceleration_y = 1000
machine_max_acceleration_z = 200
machine_max_acceleration_e = 5000
machine_max_acceleration_extruding = 1000
machine_max_acceleration_travel = 1000
machine_max_acceleration_retracting = 1000
machine_max_jerk_x = 8
machine_max_jerk_y = 8
machine_max_jerk_z = 0.4
machine_max_jerk_e = 4.5
start_gcode = G21
end_gcode = M84
)";

cam::profile::FdmMachine::Motion limits() {
    cam::profile::FdmMachine::Motion motion;
    motion.max_speed_mm_per_s = Vector4d(200, 200, 12, 120);
    motion.max_acceleration_mm_per_s2 = Vector4d(1000, 1000, 200, 5000);
    motion.jerk_mm_per_s = Vector4d(8, 8, 0.4, 4.5);
    return motion;
}

/// Times the G1 words of a program with relative E.
double our_seconds(const std::string& program) {
    cam::motion::Planner planner(limits());
    Vector4d at = Vector4d::Zero();
    double speed = 0;
    std::istringstream in(program);
    for (std::string line; std::getline(in, line);) {
        if (line.rfind("G1 ", 0) != 0) {
            continue;
        }
        Vector4d to = at;
        to[3] = 0;
        std::istringstream words(line.substr(3, line.find(';') - 3));
        for (std::string word; words >> word;) {
            const double value = std::stod(word.substr(1));
            const std::size_t axis = std::string("XYZE").find(word[0]);
            if (axis != std::string::npos) {
                to[static_cast<Eigen::Index>(axis)] = value;
            } else if (word[0] == 'F') {
                speed = value / 60;
            }
        }
        Vector4d delta = to - at;
        delta[3] = to[3];
        planner.add({delta, speed, 1000, 0});
        at = to;
    }
    const std::vector<double> slots = planner.finish();
    return std::accumulate(slots.begin(), slots.end(), 0.0);
}

double their_seconds(const std::string& program) {
    const std::string label = "; estimated printing time (normal mode) = ";
    const std::size_t at = program.find(label);
    if (at == std::string::npos) {
        return -1;
    }
    std::istringstream in(
        program.substr(at + label.size(), program.find('\n', at) - at - label.size()));
    double seconds = 0;
    for (std::string word; in >> word;) {
        const double value = std::stod(word);
        seconds += word.back() == 'h' ? 3600 * value : word.back() == 'm' ? 60 * value : value;
    }
    return seconds;
}

TEST(PlannerOracle, PrusaSlicerTimesTheSameProgramAlike) {
    if (std::system("command -v prusa-slicer > /dev/null") != 0) {
        GTEST_SKIP() << "prusa-slicer is not installed";
    }
    const tests::TempDir folder;
    ASSERT_TRUE(decomp::write_file(folder / "config.ini", kSlicerConfig));
    const std::vector<std::pair<std::string, tests::TriMesh>> shapes = {
        {"box", tests::box({0, 0, 0}, {40, 40, 10})}, {"ball", tests::sphere(15, 60, 40)}};
    for (const auto& [name, mesh] : shapes) {
        const std::string stem = (folder / name).string();
        ASSERT_TRUE(decomp::write_file(stem + ".stl", decomp::io::stl_bytes(mesh)));
        const std::string command = "prusa-slicer --loglevel 1 --load " +
                                    (folder / "config.ini").string() + " --export-gcode --output " +
                                    stem + ".gcode " + stem + ".stl > /dev/null 2>&1";
        ASSERT_EQ(std::system(command.c_str()), 0);
        const std::string program = decomp::read_file(stem + ".gcode").value();
        const double theirs = their_seconds(program);
        const double ours = our_seconds(program);
        std::printf("%s: ours %.1f s, theirs %.1f s\n", name.c_str(), ours, theirs);
        EXPECT_NEAR(ours / theirs, 1, 0.03) << name;
    }
}

}  // namespace
