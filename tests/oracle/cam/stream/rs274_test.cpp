// SPDX-License-Identifier: GPL-3.0-or-later
// LinuxCNC's interpreter as a second opinion on modal state: what our replay says after line k, and
// what the preamble of a resumed job brings about, is what rs274 says after reading the program up
// to k.
#include "cam/stream/resume.h"
#include "tests/support/run_program.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <sstream>

namespace {

using cam::stream::Flavour;
using cam::stream::ModalState;

/// The state of an interpreter, by the canonical calls that it made.
struct Canon {
    std::map<std::string, std::string> last;  ///< call to its arguments
    std::vector<double> position;             ///< X Y Z A B C of the last motion, in mm
    bool spindle = false;
    bool mist = false;
    bool flood = false;
    bool inches = false;
    double feed_mm_per_min = 0;
};

constexpr double kMark = 0.125;  ///< seconds of a pause that ends what is looked at

std::string interpreter() {
    for (const char* folder : {"/usr/bin", "/usr/local/bin"}) {
        const std::string path = std::string(folder) + "/rs274";
        if (std::filesystem::exists(path)) {
            return path;
        }
    }
    return {};
}

std::vector<double> numbers(const std::string& text) {
    std::vector<double> out;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, ',');) {
        out.push_back(std::strtod(word.c_str(), nullptr));
    }
    return out;
}

/// Values are given in the unit that is active at the call.
std::vector<double> in_mm(std::vector<double> values, bool inches) {
    for (std::size_t i = 0; i < values.size() && i < 6; ++i) {
        values[i] *= inches ? 25.4 : 1;
    }
    return values;
}

Canon read_by_rs274(const std::string& program) {
    const tests::TempDir folder;
    const std::string file = folder / "program.ngc";
    EXPECT_TRUE(decomp::write_file(file, program + "G4 P0.125\nM2\n"));
    const auto run = tests::run_program({interpreter(), "-g", file});
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
    Canon canon;
    std::istringstream lines(run.out);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t open = line.find('(');
        const std::size_t close = line.rfind(')');
        const std::size_t begin = line.find_first_not_of("0123456789 .N", 0);
        if (open == std::string::npos || close == std::string::npos || begin >= open) {
            continue;
        }
        const std::string call = line.substr(begin, open - begin);
        const std::string arguments = line.substr(open + 1, close - open - 1);
        if (call == "DWELL" && numbers(arguments).front() == kMark) {
            break;  // what follows is the end of the program, which sets modes of its own
        }
        canon.last[call] = arguments;
        if (call == "STRAIGHT_TRAVERSE" || call == "STRAIGHT_FEED") {
            canon.position = in_mm(numbers(arguments), canon.inches);
        } else if (call == "ARC_FEED") {
            const std::vector<double> arc = in_mm(numbers(arguments), canon.inches);
            // In the XY plane: end 1, end 2, centre 1, centre 2, rotation, end of the axis.
            canon.position.resize(6);
            canon.position[0] = arc[0];
            canon.position[1] = arc[1];
            canon.position[2] = arc[5];
        } else if (call == "START_SPINDLE_CLOCKWISE" || call == "START_SPINDLE_COUNTERCLOCKWISE") {
            canon.spindle = true;
        } else if (call == "STOP_SPINDLE_TURNING") {
            canon.spindle = false;
        } else if (call == "FLOOD_ON" || call == "FLOOD_OFF") {
            canon.flood = call == "FLOOD_ON";
        } else if (call == "MIST_ON" || call == "MIST_OFF") {
            canon.mist = call == "MIST_ON";
        } else if (call == "SET_FEED_RATE") {
            canon.feed_mm_per_min = in_mm(numbers(arguments), canon.inches).front();
        } else if (call == "USE_LENGTH_UNITS") {
            canon.inches = arguments.find("INCH") != std::string::npos;
        }
    }
    return canon;
}

const std::vector<std::string> kProgram = {
    "G21 G90 G94 G17 G54",
    "S8000 M3",
    "M8",
    "G0 Z10",
    "G0 X5 Y5",
    "G1 Z-1 F120",
    "G1 X40 F600",
    "Y30",
    "X5.5",
    "G3 X5.5 Y20 I0 J-5",
    "G1 X10 Y5 F450",
    "S9500",
    "G91",
    "X2.5",
    "Y1.25 Z-0.5",
    "G90",
    "G0 Z10",
    "M9",
    "G55",
    "G0 X0 Y0",
    "G1 Z-2 F90",
    "G20",
    "G1 X1.5 F20",
    "Y0.75",
    "G21",
    "M7",
    "G1 X3 Y4 F300",
    "M5",
};

std::string first_lines(std::size_t count) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i) {
        out += kProgram[i] + "\n";
    }
    return out;
}

void expect_same(const Canon& canon, const ModalState& state, const std::string& where) {
    EXPECT_EQ(canon.inches, state.inches) << where;
    for (std::size_t axis = 0; axis < 3 && axis < canon.position.size(); ++axis) {
        if (!std::isnan(state.position_mm.at(axis))) {
            EXPECT_NEAR(canon.position[axis], state.position_mm.at(axis), 0.002) << where;
        }
    }
    EXPECT_EQ(canon.spindle, state.spindle != 5) << where;
    EXPECT_EQ(canon.flood, state.flood) << where;
    EXPECT_EQ(canon.mist, state.mist) << where;
    if (state.spindle != 5) {
        const std::vector<double> speed = numbers(canon.last.at("SET_SPINDLE_SPEED"));
        EXPECT_DOUBLE_EQ(speed.back(), state.spindle_rpm) << where;
    }
    if (state.feed_mm_per_min > 0) {
        EXPECT_NEAR(canon.feed_mm_per_min, state.feed_mm_per_min, 0.01) << where;
    }
}

TEST(Rs274, AgreesWithTheReplayAfterEveryLine) {
    if (interpreter().empty()) {
        GTEST_SKIP() << "rs274 is not installed (Debian package linuxcnc-uspace)";
    }
    const std::string program = first_lines(kProgram.size());
    for (std::size_t k = 6; k <= kProgram.size(); ++k) {
        const ModalState state =
            cam::stream::replay(program, Flavour::Mill, static_cast<long>(k) + 1);
        expect_same(read_by_rs274(first_lines(k)), state, "after line " + std::to_string(k));
    }
}

TEST(Rs274, ThePreambleBringsAboutTheStateOfTheLinesBefore) {
    if (interpreter().empty()) {
        GTEST_SKIP() << "rs274 is not installed (Debian package linuxcnc-uspace)";
    }
    const std::string program = first_lines(kProgram.size());
    cam::stream::WireOptions options;
    options.flavour = Flavour::Mill;
    for (long line = 8; line <= static_cast<long>(kProgram.size()); ++line) {
        const auto plan = cam::stream::plan_resume(program, options, line - 1, 0);
        ASSERT_TRUE(plan) << plan.error().text();
        ASSERT_EQ(plan->first_line, line);
        std::string preamble;
        for (const std::string& text : plan->preamble) {
            preamble += text + "\n";
        }
        expect_same(read_by_rs274(preamble), plan->state, "line " + std::to_string(line));
    }
}

}  // namespace
