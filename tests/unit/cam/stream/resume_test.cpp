// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/resume.h"

#include "decomp/base/rng.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace cam::stream;

/// A program of random modes and moves, as a slicer or a CAM program could write it.
std::string random_program(Flavour flavour, std::uint64_t seed, int lines) {
    decomp::Rng rng(seed);
    std::string out = flavour == Flavour::Print
                          ? "G21\nG90\nM82\nG28\nM140 S60\nM109 S205\nG1 X5 Y5 Z0.2 F3000\n"
                          : "G21\nG90\nG17\nG54\nM3 S9000\nG0 X5 Y5 Z10\nG1 Z-1 F200\n";
    for (int i = 0; i < lines; ++i) {
        const auto number = [&](double high) {
            return std::to_string(rng.uniform(1, high)).substr(0, 5);
        };
        switch (rng.below(flavour == Flavour::Print ? 12 : 9)) {
            case 0:
                out += "G1 X" + number(90) + " Y" + number(90) + " F" + number(3000) + "\n";
                break;
            case 1:
                out += "G1 Z" + number(9) + "\n";
                break;
            case 2:
                out += rng.below(2) == 0 ? "G91\n" : "G90\n";
                break;
            case 3:
                out +=
                    flavour == Flavour::Print ? "M106 S" + number(255) + "\n" : std::string("M8\n");
                break;
            case 4:
                out += flavour == Flavour::Print ? "M104 S" + number(230) + "\n"
                                                 : "S" + number(9000) + "\n";
                break;
            case 5:
                out += flavour == Flavour::Print ? "M83\n" : "M9\n";
                break;
            case 6:
                out += "G0 X" + number(90) + "\n";
                break;
            case 7:
                out += flavour == Flavour::Print ? "M82\n" : "M5\n";
                break;
            case 8:
                out += flavour == Flavour::Print ? "G92 E0\n" : "M4 S7000\n";
                break;
            case 9:
                out += "M221 S" + number(120) + "\n";
                break;
            default:
                out += "G1 X" + number(90) + " E" + number(9) + "\n";
        }
    }
    return out;
}

void expect_same_modes(const ModalState& a, const ModalState& b, Flavour flavour,
                       const std::string& where) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(a.position_mm.at(axis), b.position_mm.at(axis), 0.0006) << where;
    }
    EXPECT_EQ(a.inches, b.inches) << where;
    EXPECT_EQ(a.absolute, b.absolute) << where;
    EXPECT_NEAR(a.feed_mm_per_min, b.feed_mm_per_min, 0.01) << where;
    if (flavour == Flavour::Print) {
        EXPECT_EQ(a.absolute_e, b.absolute_e) << where;
        EXPECT_NEAR(a.e_mm, b.e_mm, 0.0001) << where;
        EXPECT_NEAR(a.nozzle_celsius[0], b.nozzle_celsius[0], 0.1) << where;
        EXPECT_NEAR(a.bed_celsius, b.bed_celsius, 0.1) << where;
        EXPECT_NEAR(a.fan_0_255, b.fan_0_255, 1) << where;
        EXPECT_NEAR(a.flow_percent, b.flow_percent, 0.1) << where;
    } else {
        EXPECT_EQ(a.spindle, b.spindle) << where;
        EXPECT_EQ(a.flood, b.flood) << where;
        EXPECT_EQ(a.coordinate_system, b.coordinate_system) << where;
        EXPECT_EQ(a.plane, b.plane) << where;
        if (a.spindle != 5) {
            EXPECT_NEAR(a.spindle_rpm, b.spindle_rpm, 0.1) << where;
        }
    }
}

/// Carried out from nothing, the preamble leaves the modes that the lines before have left.
TEST(Resume, ThePreambleBringsAboutTheStateOfTheLinesBefore) {
    for (const Flavour flavour : {Flavour::Print, Flavour::Mill}) {
        WireOptions options;
        options.flavour = flavour;
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const std::string program = random_program(flavour, seed, 120);
            for (long answered = 20; answered < 120; answered += 7) {
                const auto plan = plan_resume(program, options, answered, 5);
                ASSERT_TRUE(plan) << plan.error().text();
                EXPECT_LE(plan->first_line, answered - 4);
                ModalState state;
                for (const std::string& line : plan->preamble) {
                    apply(state, read_words(line), flavour);
                }
                expect_same_modes(
                    state, plan->state, flavour,
                    "seed " + std::to_string(seed) + " line " + std::to_string(plan->first_line));
            }
        }
    }
}

TEST(Resume, AJobThatHasSaidNoPlaceCannotGoOn) {
    const auto plan = plan_resume("G21\nG28\nM109 S200\nG1 X1 F600\n", {}, 3, 1);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, "stream.position_unknown");
}

TEST(Resume, APlaceSummedUpBeyondAllMachinesIsNone) {
    std::string far = "G21\nG90\nG1X1Y1Z1F600\nG91\n";
    std::string fed = "G21\nG90\nG1X1Y1Z1F600\nM83\n";
    for (int i = 0; i < 200; ++i) {
        far += "G1X9000000\n";
        fed += "G1E9000000\n";
    }
    for (const std::string& program : {far, fed}) {
        const auto plan = plan_resume(program, {}, 204, 1);
        ASSERT_TRUE(plan);
        EXPECT_LT(plan->first_line, 20);
        EXPECT_LE(std::abs(plan->state.position_mm[0]), 1e8);
        EXPECT_LE(std::abs(plan->state.e_mm), 1e8);
    }
}

TEST(Resume, TheFirstMoveOfTheRestSaysHowItMoves) {
    const std::string program = "G90\nG0X1Y1Z1\nG3X5Y5I2J2F100\nX1Y1I-2J-2\n";
    WireOptions options;
    options.flavour = Flavour::Mill;
    const auto plan = plan_resume(program, options, 3, 0);
    ASSERT_TRUE(plan);
    const auto job = prepare_rest(program, options, plan->first_line, plan->state, plan->preamble);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->lines.text(plan->preamble.size()), "G3X1Y1I-2J-2");
}

TEST(Standing, IsTheLastAttemptsLastWord) {
    JournalHead head;
    head.program = "a.nc";
    head.first_line = 7;
    head.preamble = {"G21"};
    head.entries = 100;
    std::string bytes;
    std::uint64_t number = 0;
    for (const std::string& text :
         {begin_record({}), std::string("allow 64"), std::string("at 3 5"),
          std::string("end failed x"), begin_record(head), std::string("allow 64"),
          std::string("at 10 12")}) {
        bytes += cam::journal::record_line(number++, text);
    }
    const auto standing = read_standing(cam::journal::read_records(bytes + "torn"));
    ASSERT_TRUE(standing) << standing.error().text();
    EXPECT_EQ(standing->head.first_line, 7);
    EXPECT_EQ(standing->head.preamble, std::vector<std::string>{"G21"});
    EXPECT_EQ(standing->acked, 10U);
    EXPECT_EQ(standing->sent, 12U);
    EXPECT_EQ(standing->allowed, 64U);
    EXPECT_FALSE(standing->ended);
    EXPECT_EQ(read_standing({}).error().code, "stream.no_journal");
}

TEST(Resume, FindsTheLineOnWhoseWayTheMachineStands) {
    const std::string program =
        "G21G90\nG0X0Y0Z5\nG1Z0F100\nX10\nY10\nG2X20Y10I5J0\nG1X0\nY0\nX10\n";
    const auto at = [&](double x, double y, double z, long first, long last) {
        AxisValues place = ModalState::unknown();
        place[0] = x;
        place[1] = y;
        place[2] = z;
        return line_through(program, Flavour::Mill, first, last, place);
    };
    EXPECT_EQ(at(10, 4.2, 0, 1, 9), 5);
    EXPECT_EQ(at(20, 10, 0, 1, 9), 6);
    EXPECT_EQ(at(10, 0, 0, 1, 9), 4);  // two lines end there: the first, for cutting air harms none
    EXPECT_EQ(at(10, 0, 0, 6, 9), 9);
    EXPECT_EQ(at(10, 0, 0, 6, 8), std::nullopt);
    EXPECT_EQ(at(3, 3, 0, 1, 9), std::nullopt);
    EXPECT_EQ(at(10, 4.2, 1, 1, 9), std::nullopt);
}

}  // namespace
