// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/post_mill.h"

#include "tests/support/mill_programs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace {

using cam::path::MillProgram;
using cam::post::post_mill;
using cam::profile::MillSetup;
using cam::profile::read_mill_setup;
using tests::ByHand;
using tests::flat_mill;

MillSetup setup_of(const std::string& dialect) {
    return read_mill_setup("linuxcnc-router-3axis", {}, {"machine.dialect=" + dialect}).value();
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        out.push_back(line);
    }
    return out;
}

bool has_line(const std::string& text, const std::string& line) {
    const auto lines = lines_of(text);
    return std::find(lines.begin(), lines.end(), line) != lines.end();
}

std::string posted(const MillProgram& program, const std::string& dialect) {
    auto text = post_mill(program, {flat_mill(1, 6)}, setup_of(dialect), "plate");
    EXPECT_TRUE(text) << text.error().text();
    return text ? *text : std::string();
}

TEST(PostMill, EveryDialectKeepsItsLinesShortAndPlain) {
    for (const std::string& dialect : cam::profile::list_mill_dialects()) {
        const std::string text = posted(tests::pocket_program(), dialect);
        const int limit = setup_of(dialect).dialect.line_limit;
        for (const std::string& line : lines_of(text)) {
            EXPECT_LE(line.size(), static_cast<std::size_t>(limit)) << dialect << ": " << line;
            EXPECT_FALSE(line.empty()) << dialect;
            EXPECT_TRUE(std::all_of(line.begin(), line.end(), [](char c) {
                return c >= ' ' && c <= '~';
            })) << line;
        }
    }
}

TEST(PostMill, AToolIsChangedAsTheDialectWantsIt) {
    EXPECT_TRUE(has_line(posted(tests::pocket_program(), "linuxcnc"), "M6 T1"));
    EXPECT_TRUE(has_line(posted(tests::pocket_program(), "linuxcnc"), "G43 H1"));
    EXPECT_FALSE(has_line(posted(tests::pocket_program(), "grbl"), "M6 T1"));
    EXPECT_TRUE(has_line(posted(tests::pocket_program(), "grbl"), "M0"));
    EXPECT_EQ(posted(tests::pocket_program(), "marlin-mill").find("M30"), std::string::npos);
}

TEST(PostMill, RapidsRiseBeforeTheyCrossAndCrossBeforeTheySink) {
    ByHand hand(tests::plate_stock());
    hand.take(1).rapid(10, 10, 1).rapid(20, 20, 5).rapid(30, 10, 2);
    const auto lines = lines_of(posted(hand.done(), "linuxcnc"));
    const auto at = std::find(lines.begin(), lines.end(), "G0 Z5.0000");
    ASSERT_NE(at, lines.end());
    const std::vector<std::string> wanted = {
        "G0 Z5.0000",           "G0 X10.0000 Y10.0000", "G0 Z1.0000", "G0 Z5.0000",
        "G0 X20.0000 Y20.0000", "G0 X30.0000 Y10.0000", "G0 Z2.0000"};
    EXPECT_EQ(std::vector<std::string>(at, at + 7), wanted);
}

TEST(PostMill, AWholeTurnIsTwoHalvesAndLinesWhereThereAreNoArcs) {
    ByHand hand(tests::plate_stock());
    hand.take(1).rapid(10, 10, 5).cut(10, 10, -1).arc({10, 10, -2}, {15, 10}, false);
    const std::string arcs = posted(hand.done(), "grblhal");
    EXPECT_TRUE(has_line(arcs, "G3 X20.000 Y10.000 Z-1.500 I5.000 J0.000"));
    EXPECT_TRUE(has_line(arcs, "G3 X10.000 Y10.000 Z-2.000 I-5.000 J0.000"));
    const std::string lines = posted(hand.done(), "roland-nc");
    EXPECT_EQ(lines.find("G3"), std::string::npos);
    EXPECT_GT(std::count(lines.begin(), lines.end(), '\n'), 60);
}

TEST(PostMill, AnArcTooLargeForTheControllerIsLines) {
    ByHand hand(tests::plate_stock());
    hand.take(1).rapid(0, 0, 5).cut(0, 0, -1).arc({40, 0, -1}, {20, -2000}, true);
    EXPECT_EQ(posted(hand.done(), "linuxcnc").find("G2 X"), std::string::npos);
}

TEST(PostMill, FeedsOfRapidsDoNotLastWhereG0MovesAtF) {
    ByHand hand(tests::plate_stock());
    hand.take(1).rapid(10, 10, 5).cut(10, 10, -1, 300).rapid(10, 10, 5).rapid(20, 10, 5);
    hand.cut(20, 10, -1, 300);
    const std::string text = posted(hand.done(), "marlin-mill");
    EXPECT_TRUE(has_line(text, "G1 Z-1.000 F300"));
    EXPECT_EQ(text.find("G1 Z-1.000\n"), std::string::npos);
}

TEST(PostMill, WhatNobodyWouldRunIsRefused) {
    const auto code = [](const MillProgram& program) {
        const auto text = post_mill(program, {flat_mill(1, 6)}, setup_of("linuxcnc"), "x");
        return text ? std::string() : text.error().code;
    };
    EXPECT_EQ(code(ByHand(tests::plate_stock()).rapid(0, 0, 5).done()), "post.mill_order");
    EXPECT_EQ(code(ByHand(tests::plate_stock()).take(2).done()), "post.mill_tool");
    EXPECT_EQ(code(ByHand(tests::plate_stock()).take(1, 0).rapid(0, 0, 5).cut(0, 0, -1).done()),
              "post.mill_order");
    EXPECT_EQ(code(ByHand(tests::plate_stock()).take(1).cut(0, 0, -1).done()), "post.mill_order");
    EXPECT_EQ(code(ByHand(tests::plate_stock()).take(1).rapid(0, 0, 5).cut(0, 0, -1, 0).done()),
              "post.mill_feed");
}

TEST(PostMill, TheSameProgramIsTheSameBytes) {
    EXPECT_EQ(posted(tests::pocket_program(), "mach"), posted(tests::pocket_program(), "mach"));
}

}  // namespace
