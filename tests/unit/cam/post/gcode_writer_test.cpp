// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/gcode_writer.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace {

using cam::post::GcodeWriter;

TEST(GcodeWriter, WritesOnlyWhatChanges) {
    GcodeWriter writer({});
    writer.move_xy({1, 2}, 0, 100);
    writer.move_z(0.2, 10);
    writer.move_xy({1, 3.25}, 0.5, 30);
    writer.move_xy({2, 3.25}, 0.5, 30);
    writer.feed_filament(-1, 25);
    EXPECT_EQ(std::move(writer).take(),
              "G1 X1 Y2 F6000\nG1 Z0.2 F600\nG1 Y3.25 E0.5 F1800\nG1 X2 E0.5\nG1 E-1 F1500\n");
}

TEST(GcodeWriter, NumbersHaveNoUselessDigitsAndNoMinusZero) {
    GcodeWriter writer({});
    for (const double x : {-0.0004, 100.0, -0.5, 0.05, 12.3456, -10.0, 0.001}) {
        writer.move_xy({x, 0}, 0, 100);
    }
    EXPECT_EQ(std::move(writer).take(),
              "G1 X0 Y0 F6000\nG1 X100\nG1 X-0.5\nG1 X0.05\nG1 X12.346\nG1 X-10\nG1 X0.001\n");
}

double sum_of_e(const std::string& text, bool relative) {
    double sum = 0;
    for (std::size_t at = text.find('E'); at != std::string::npos; at = text.find('E', at + 1)) {
        const double value = std::strtod(text.c_str() + at + 1, nullptr);
        sum = relative ? sum + value : value;
    }
    return sum;
}

TEST(GcodeWriter, FilamentDoesNotDriftHoweverManyMoves) {
    for (const bool relative : {true, false}) {
        cam::profile::Dialect dialect;
        dialect.relative_e = relative;
        GcodeWriter writer(dialect);
        // each move feeds 0.4 of the last decimal: rounded one by one, nothing would ever be fed
        for (int i = 0; i < 10000; ++i) {
            writer.move_xy({i % 2 == 0 ? 1.0 : 2.0, 0}, 0.000004, 30);
        }
        EXPECT_NEAR(sum_of_e(std::move(writer).take(), relative), 0.04, 0.5e-5);
    }
}

TEST(GcodeWriter, AMoveBelowTheGridLeavesItsFilamentToTheNext) {
    GcodeWriter writer({});
    writer.move_xy({1, 1}, 0, 100);
    writer.move_xy({1.0001, 1}, 0.25, 30);
    writer.move_xy({2, 1}, 0.25, 30);
    EXPECT_EQ(std::move(writer).take(), "G1 X1 Y1 F6000\nG1 X2 E0.5 F1800\n");
}

TEST(GcodeWriter, ForgettingWritesEverythingAgain) {
    GcodeWriter writer({});
    writer.move_xy({1, 1}, 0, 100);
    writer.raw("G28");
    writer.forget();
    writer.move_xy({1, 1}, 0, 100);
    EXPECT_EQ(std::move(writer).take(), "G1 X1 Y1 F6000\nG28\nG1 X1 Y1 F6000\n");
}

}  // namespace
