// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/mill_proofs.h"

#include <gtest/gtest.h>

/// A sound program passes; each fault that a hand or a bug may put into its text is named with its
/// line.
namespace {

using cam::millproof::Fault;
using cam::millproof::MillProof;
using cam::millproof::prove;
using tests::fault_of;
using tests::line_with;
using tests::words_of;

std::string replaced(std::string text, const std::string& from, const std::string& to,
                     int which = 1) {
    std::size_t at = 0;
    for (; which > 0; --which) {
        at = text.find(from, at + 1);
        EXPECT_NE(at, std::string::npos) << from;
    }
    return text.replace(at, from.size(), to);
}

/// A pocket in a plate, and its program.
class Pocket : public testing::Test {
  protected:
    Pocket() {
        part_ = tests::pocket_part();
        text_ = tests::text_of(tests::pocket_program());
    }

    MillProof judged(const std::string& text) {
        return prove(text, tests::pocket_job(part_), {}).value();
    }

    /// The same where a ball, tool 2, lies at hand.
    MillProof judged_with_a_ball(const std::string& text) {
        auto job = tests::pocket_job(part_);
        job.tools.push_back({tests::ball_mill(2, 6), 800});
        return prove(text, job, {}).value();
    }

    decomp::mesh::TriMesh part_;
    std::string text_;
};

TEST_F(Pocket, TheSoundProgramPasses) {
    const MillProof proof = judged(text_);
    EXPECT_TRUE(proof.passed()) << words_of(proof);
}

TEST_F(Pocket, OneBlockTwoTenthsDownIsAGougeInItsLine) {
    // The lane along X at the full depth, its height restored by the next block.
    std::string wrong = replaced(text_, "G1 X29.0000", "G1 X29.0000 Z-4.2000", 3);
    const long line = line_with(wrong, "Z-4.2000");
    wrong = replaced(wrong, "G1 Y19.0000", "G1 Y19.0000 Z-4.0000", 2);
    const Fault fault = fault_of(judged(wrong), "gouge");
    EXPECT_EQ(fault.line, line) << words_of(judged(wrong));
    EXPECT_NEAR(judged(wrong).figures.max_gouge_mm, 0.2, 0.001);
}

TEST_F(Pocket, ADroppedRetractIsARapidThroughTheStock) {
    tests::ByHand hand(tests::plate_stock());
    hand.take(1).rapid(11, 11, 5).cut(11, 11, -2, 200).cut(11, 19, -2).rapid(11, 19, 5);
    hand.rapid(29, 19, 5).cut(29, 19, -2, 200).rapid(29, 19, 5);
    const std::string sound = tests::text_of(hand.done());
    const std::string wrong = replaced(sound, "G0 Z5.0000\nG0 X29", "G0 X29");
    EXPECT_EQ(fault_of(judged(sound), "rapid").kind, "");
    const Fault fault = fault_of(judged(wrong), "rapid");
    EXPECT_EQ(fault.line, line_with(wrong, "G0 X29"));
}

TEST_F(Pocket, AWrongToolLeavesMaterialAndIsNamed) {
    const std::string wrong = replaced(replaced(text_, "M6 T1", "M6 T2"), "H1", "H2");
    const MillProof proof = judged_with_a_ball(wrong);
    const Fault fault = fault_of(proof, "excess");
    EXPECT_GT(fault.line, 0) << words_of(proof);
    EXPECT_NE(fault.what.find("tool 2"), std::string::npos) << fault.what;
    const std::string nobodys = replaced(text_, "M6 T1", "M6 T7");
    EXPECT_EQ(fault_of(judged(nobodys), "tool").line, line_with(nobodys, "M6 T7"));
}

TEST_F(Pocket, InchesAreNamed) {
    const std::string wrong = replaced(text_, "G21", "G20");
    EXPECT_EQ(fault_of(judged(wrong), "units").line, line_with(wrong, "G20"));
}

TEST_F(Pocket, TenTimesTheFeedIsNamed) {
    const std::string wrong = replaced(text_, "F600", "F6000");
    EXPECT_EQ(fault_of(judged(wrong), "feed").line, line_with(wrong, "F6000"));
}

TEST_F(Pocket, ACutWithoutTheSpindleIsNamed) {
    const std::string wrong = replaced(text_, "M3 S12000\n", "");
    EXPECT_EQ(fault_of(judged(wrong), "spindle").line, line_with(wrong, "G1 Z"));
}

TEST_F(Pocket, ACutMadeARapidIsNamed) {
    const std::string wrong = replaced(text_, "G1 X29", "G0 X29");
    EXPECT_EQ(fault_of(judged(wrong), "rapid").line, line_with(wrong, "G0 X29"));
}

TEST_F(Pocket, ASpindleThatTurnsTooFastOrTheWrongWayIsNamed) {
    const std::string fast = replaced(text_, "S12000", "S120000");
    EXPECT_EQ(fault_of(judged(fast), "speed").line, line_with(fast, "S120000"));
    const std::string wrong = replaced(text_, "M3 S", "M4 S");
    EXPECT_EQ(fault_of(judged(wrong), "spindle").line, line_with(wrong, "M4"));
}

TEST_F(Pocket, AProgramThatIsCutShortIsNamed) {
    EXPECT_EQ(fault_of(judged(text_.substr(0, text_.size() / 2)), "end").kind, "end");
}

TEST_F(Pocket, AnythingMayBeReadAndNothingBreaks) {
    unsigned state = 7;
    for (int trial = 0; trial < 40; ++trial) {
        std::string wrong = text_;
        for (int i = 0; i < 5; ++i) {
            state = state * 1664525U + 1013904223U;
            wrong[(state >> 8U) % wrong.size()] = static_cast<char>(state >> 24U);
        }
        EXPECT_EQ(judged(wrong).figures.lines, std::count(wrong.begin(), wrong.end(), '\n'));
    }
}

}  // namespace
