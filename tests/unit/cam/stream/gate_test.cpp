// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/gate.h"

#include <gtest/gtest.h>

namespace {

using namespace cam::stream;

Limits mill() {
    Limits limits;
    limits.flavour = Flavour::Mill;
    limits.low_mm = {0, 0, -45};
    limits.high_mm = {300, 180, 0};
    limits.max_feed_mm_per_min = 2000;
    limits.max_spindle_rpm = 10000;
    return limits;
}

std::vector<std::string> codes(const std::vector<Objection>& objections) {
    std::vector<std::string> out;
    for (const Objection& objection : objections) {
        out.push_back(objection.code + ":" + std::to_string(objection.line));
    }
    return out;
}

using Codes = std::vector<std::string>;

TEST(Gate, AProgramInsideTheTravelPasses) {
    const auto found = examine_bounds("G21 G90\nG0 X10 Y10 Z5\nG1 Z-3 F600\nG2 X10 Y10 I5 J0\n",
                                      mill(), {{"G54", {20, 20, -30}}});
    EXPECT_EQ(codes(found), Codes{});
}

TEST(Gate, WorkOffsetsAndArcsCount) {
    EXPECT_EQ(codes(examine_bounds("G0 X290 Y5 Z-5\n", mill(), {{"G54", {20, 0, 0}}})),
              Codes{"stream.bounds:1"});
    EXPECT_EQ(codes(examine_bounds("G0 X3 Y90 Z-5\nG2 X3 Y90 I4 J0 F100\n", mill(), {{"G54", {}}})),
              Codes{});
    EXPECT_EQ(
        codes(examine_bounds("G0 X3 Y90 Z-5\nG2 X3 Y90 I-4 J0 F100\n", mill(), {{"G54", {}}})),
        Codes{"stream.bounds:2"});
    EXPECT_EQ(codes(examine_bounds("G53 G0 Z5\n", mill(), {})), Codes{"stream.bounds:1"});
    // Offsets that nobody knows yet are not guessed.
    EXPECT_EQ(codes(examine_bounds("G0 X290 Y5 Z-5\n", mill(), {})), Codes{});
}

TEST(Gate, FeedsSpeedsAxesAndCodesAreLookedAt) {
    EXPECT_EQ(codes(examine_bounds("G1 X1 F3000\nM3 S20000\nG1 A5\nG187 P1\n", mill(), {})),
              (Codes{"stream.feed:1", "stream.spindle:2", "stream.missing_axis:3",
                     "stream.unknown_code:4"}));
}

TEST(Gate, ANumberThatNoMachineIsToldIsUnreadable) {
    EXPECT_EQ(codes(examine_bounds("G22222222222222 X1\nG1 X1e400\n", mill(), {})),
              Codes{"stream.unreadable_line:1"});
    EXPECT_EQ(codes(examine_bounds("G1 X10000001 F100\n", mill(), {{"G54", {}}})),
              Codes{"stream.unreadable_line:1"});
    EXPECT_EQ(codes(examine_bounds("G1 X10000000 F100\n", mill(), {{"G54", {}}})),
              Codes{"stream.bounds:1"});
}

TEST(Gate, APrintersHeatersAreLookedAt) {
    Limits limits;
    limits.max_nozzle_celsius = 250;
    limits.max_bed_celsius = 110;
    limits.high_mm = {250, 210, 200};
    limits.low_mm = {0, 0, 0};
    EXPECT_EQ(codes(examine_bounds("M109 S280\nG28\nG1 X300 Y1 Z1\n", limits, {})),
              (Codes{"stream.temperature:1", "stream.bounds:3"}));
}

TEST(Gate, AnotherMachineOneInMotionAndALockedOneAreRefused) {
    cam::protocol::Identity identity;
    identity.firmware = "Grbl 1.1h";
    identity.axes = "XYZ";
    EXPECT_EQ(codes(examine_machine(identity, {"Grbl", "", 3, true})), Codes{});
    EXPECT_EQ(codes(examine_machine(identity, {"grblHAL", "", 4, true})),
              (Codes{"stream.identity:0", "stream.missing_axis:0"}));
    identity.busy = true;
    identity.homed = false;
    EXPECT_EQ(codes(examine_machine(identity, {"Grbl", "", 3, true})),
              (Codes{"stream.machine_busy:0", "stream.not_homed:0"}));
}

TEST(Gate, OnlyWhatIsAllowedPasses) {
    const std::vector<Objection> objections = {{"stream.bounds", 4, "far", 2},
                                               {"stream.feed", 1, "fast", 1}};
    EXPECT_TRUE(judge(objections, {"bounds", "feed"}));
    const auto judged = judge(objections, {"feed"});
    ASSERT_FALSE(judged);
    EXPECT_EQ(judged.error().code, "stream.bounds");
    EXPECT_EQ(judged.error().where, "line 4");
    EXPECT_NE(judged.error().hint.find("--allow bounds"), std::string::npos);
}

}  // namespace
