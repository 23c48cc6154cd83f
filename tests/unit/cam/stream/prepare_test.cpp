// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/prepare.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace cam::stream;
using cam::protocol::LineKind;

std::vector<std::string> texts(const WireJob& job) {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < job.lines.size(); ++i) {
        out.emplace_back(job.lines.text(i));
    }
    return out;
}

TEST(Prepare, APrintIsSentBareAndEndsWithItsPosition) {
    const auto job = prepare("; made by\nG28 W ; home\nG1 X10 Y5 Z1 F600\n\nM84\n", {});
    ASSERT_TRUE(job) << job.error().text();
    EXPECT_EQ(texts(*job),
              (std::vector<std::string>{"G28W", "G1X10Y5Z1F600", "M84", "M400", "M114"}));
    EXPECT_EQ(job->lines.source(1), 3);
    EXPECT_EQ(job->lines.kind(3), LineKind::Drain);
    ASSERT_NE(job->lines.expected(3), nullptr);
    EXPECT_DOUBLE_EQ((*job->lines.expected(3))[0], 10);
}

TEST(Prepare, AChangeOfToolStopsAsksAndGoesOnAsBefore) {
    WireOptions options;
    options.flavour = Flavour::Mill;
    options.parks = true;
    options.park_z_mm = -2;
    const auto job = prepare(
        "G90 G21\nM3 S8000\nM8\nG1 X1 Y1 Z5 F100\nM6 T2 (ball 3)\nX5\nM30\nG0 X99\n", options);
    ASSERT_TRUE(job) << job.error().text();
    EXPECT_EQ(texts(*job),
              (std::vector<std::string>{"G90G21", "M3S8000", "M8", "G1X1Y1Z5F100", "G4P0.01", "M5",
                                        "M9", "G53G0Z-2", "G4P0.01", "M3S8000", "G4P4", "M8",
                                        "G1X5", "G4P0.01", "M30"}));
    EXPECT_EQ(job->lines.kind(8), LineKind::Ask);
    EXPECT_NE(job->lines.question(8).find("tool 2 (ball 3)"), std::string::npos);
    EXPECT_TRUE(std::isnan((*job->lines.expected(13))[2]));
}

TEST(Prepare, LinesThatWriteTheControllersMemoryTravelAlone) {
    WireOptions options;
    options.flavour = Flavour::Mill;
    const auto job = prepare("G54\nG0 X1\nG55\nG10 L20 P1 X0\n", options);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->lines.kind(0), LineKind::Send);
    EXPECT_EQ(job->lines.kind(2), LineKind::Alone);
    EXPECT_EQ(job->lines.kind(3), LineKind::Alone);
}

TEST(Prepare, WhatWouldBreakTheConversationIsRefusedWithItsLine) {
    WireOptions mill;
    mill.flavour = Flavour::Mill;
    const auto code = [](const auto& result) {
        return result ? std::string() : result.error().code + " " + result.error().where;
    };
    EXPECT_EQ(code(prepare("G28\nM110 N5\n", {})), "stream.forbidden_command line 2");
    EXPECT_EQ(code(prepare("$X\n", mill)), "stream.unreadable_line line 1");
    EXPECT_EQ(code(prepare("G91\nM6 T1\n", mill)), "stream.relative_tool_change line 2");
    EXPECT_EQ(code(prepare("G1 X1 Q\n#1=3\n", mill)), "stream.unreadable_line line 2");
    EXPECT_EQ(code(prepare("G1 X" + std::string(90, '1') + "\n", {})),
              "stream.line_too_long line 1");
    EXPECT_EQ(code(prepare("; nothing\n", {})), "stream.empty ");
}

TEST(Prepare, TimesGrowFromZeroToTheWhole) {
    std::string program = "G21 G90\nG1 X0 Y0 Z0 F600\n";
    for (int i = 0; i < 300; ++i) {
        program += i % 2 == 0 ? "G1 X10\n" : "G1 X0\n";
    }
    const auto job = prepare(program, {});
    ASSERT_TRUE(job);
    EXPECT_NEAR(job->total_seconds, 300, 1);
    EXPECT_DOUBLE_EQ(job->seconds_until(0), 0);
    EXPECT_NEAR(job->seconds_until(152), 150, 3);
    EXPECT_DOUBLE_EQ(job->seconds_until(job->lines.size()), job->total_seconds);
}

}  // namespace
