// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/modal.h"

#include "cam/stream/words.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace cam::stream;

ModalState after(std::initializer_list<const char*> lines, Flavour flavour,
                 Motion* last = nullptr) {
    ModalState state;
    for (const char* line : lines) {
        const Motion motion = apply(state, read_words(bare_line(line)), flavour);
        if (last != nullptr) {
            *last = motion;
        }
    }
    return state;
}

TEST(Words, CommentsNumbersSumsAndSpacesGo) {
    EXPECT_EQ(bare_line("N12 g1 x1.5 (to the edge) Y-2 ; fast\r"), "G1X1.5Y-2");
    EXPECT_EQ(bare_line("N7 G1 X3*99"), "G1X3");
    EXPECT_EQ(bare_line("%"), "");
    EXPECT_EQ(bare_line("M117 Layer 3 of 9"), "M117 Layer 3 of 9");
    EXPECT_EQ(comment_of("M0 (turn the part) ; now"), "turn the part now");
    EXPECT_FALSE(read_words("G1X#5").readable);
    EXPECT_TRUE(read_words("G28X").find('X')->bare);
}

TEST(Modal, AMoveKeepsWhatItDoesNotSay) {
    const ModalState state = after({"G21 G90", "G0 X1 Y2 Z3", "X5", "G91", "Y-1"}, Flavour::Mill);
    EXPECT_DOUBLE_EQ(state.position_mm[0], 5);
    EXPECT_DOUBLE_EQ(state.position_mm[1], 1);
    EXPECT_DOUBLE_EQ(state.position_mm[2], 3);
    EXPECT_TRUE(std::isnan(state.position_mm[3]));
    EXPECT_FALSE(state.absolute);
    EXPECT_EQ(state.motion, 0);
}

TEST(Modal, InchesAreConvertedAndDegreesAreNot) {
    const ModalState state = after({"G20", "G1 X1 A90 F10"}, Flavour::Mill);
    EXPECT_DOUBLE_EQ(state.position_mm[0], 25.4);
    EXPECT_DOUBLE_EQ(state.position_mm[3], 90);
    EXPECT_DOUBLE_EQ(state.feed_mm_per_min, 254);
}

TEST(Modal, APrinterKeepsItsExtruderHeatersAndFan) {
    const ModalState state = after({"M82", "G92 E0", "G28", "M109 S210", "M190 S60", "M106 S128",
                                    "G1 X1 Y1 Z1 E2 F600", "M83", "G1 X2 E0.5", "M220 S90"},
                                   Flavour::Print);
    EXPECT_DOUBLE_EQ(state.e_mm, 2.5);
    EXPECT_DOUBLE_EQ(state.nozzle_celsius[0], 210);
    EXPECT_DOUBLE_EQ(state.bed_celsius, 60);
    EXPECT_DOUBLE_EQ(state.fan_0_255, 128);
    EXPECT_DOUBLE_EQ(state.speed_percent, 90);
    EXPECT_FALSE(state.absolute_e);
    EXPECT_DOUBLE_EQ(state.feed_mm_per_min, 600);
}

TEST(Modal, HomingLeavesThePlaceToTheMachine) {
    const ModalState state = after({"G1 X1 Y2 Z3 F600", "G28 X"}, Flavour::Print);
    EXPECT_TRUE(std::isnan(state.position_mm[0]));
    EXPECT_DOUBLE_EQ(state.position_mm[1], 2);
}

TEST(Modal, AnArcReachesAsFarAsItsCircle) {
    Motion motion;
    (void)after({"G0 X10 Y0 Z0", "G3 X-10 Y0 I-10 J0 F100"}, Flavour::Mill, &motion);
    EXPECT_NEAR(motion.high[1], 10, 1e-9);
    EXPECT_NEAR(motion.low[1], 0, 1e-9);
    EXPECT_NEAR(motion.length_mm, std::hypot(20, 3.14159265 * 10), 25);
    (void)after({"G0 X10 Y0 Z0", "G2 X10 Y0 I-10 J0 F100"}, Flavour::Mill, &motion);
    EXPECT_NEAR(motion.low[0], -10, 1e-9);
    EXPECT_NEAR(motion.low[1], -10, 1e-9);
    (void)after({"G0 X0 Y0 Z0", "G2 X10 Y0 R5 F100"}, Flavour::Mill, &motion);
    EXPECT_NEAR(motion.high[1], 5, 1e-6);
}

TEST(Modal, MachineCoordinatesMakeTheWorkPlaceUnknown) {
    Motion motion;
    const ModalState state = after({"G0 X1 Y2 Z3", "G53 G0 Z0"}, Flavour::Mill, &motion);
    EXPECT_TRUE(motion.machine_coordinates);
    EXPECT_TRUE(std::isnan(state.position_mm[2]));
    EXPECT_DOUBLE_EQ(state.position_mm[0], 1);
}

}  // namespace
