// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/gcode_reader.h"
#include "tests/unit/cam/verify/print_box.h"

#include <gtest/gtest.h>

namespace {

using cam::verify::GcodeLine;
using cam::verify::GcodeReader;
using tests::box_part;
using tests::print_box;

GcodeLine read(const std::string& text) {
    GcodeReader reader(text);
    GcodeLine line;
    EXPECT_TRUE(reader.next(line));
    return line;
}

cam::verify::Proof prove(const std::string& text,
                         const cam::profile::FdmSetup& setup = tests::proof_setup()) {
    auto proof = cam::verify::examine(text, {}, setup, {.strangers_program = true}, {});
    EXPECT_TRUE(proof.has_value()) << (proof ? "" : proof.error().text());
    return proof ? *proof : cam::verify::Proof{};
}

/// Bead of 10 mm along X; `start` sets the modes, `words` holds the move.
double extruded(const std::string& start, const std::string& words) {
    return prove("M104 S210\nM109 S210\nG28\nG1 X0 Y0 Z0.2 F600\n" + start + words)
        .figures.filament_mm;
}

TEST(GcodeReader, ReadsWordsWithAndWithoutSpacesNumbersChecksumsAndComments) {
    for (const char* text : {"G1 X1.5 Y-2 E.03", "g1x1.5y-2e.03", "N12 G1 X1.5 Y-2 E.03*71",
                             " G1 X+1.5 (to) Y-2. E0.03 ; end", "G01 X1.50 Y-2 E3e-2"}) {
        const GcodeLine line = read(text);
        ASSERT_EQ(line.kind, GcodeLine::Kind::Command) << text;
        EXPECT_EQ(line.words[0].value, 1) << text;
        EXPECT_EQ(line.value('X', 0), 1.5) << text;
        EXPECT_EQ(line.value('Y', 0), -2) << text;
    }
    // "3e-2" is E3 followed by E-2: G-code has no exponents.
    EXPECT_EQ(read("G1 E3e-2").value('E', 0), 3);
    EXPECT_EQ(read("G28 X Y").find('X')->has_value, false);
    EXPECT_EQ(read(";TYPE:brim").comment, "TYPE:brim");
    EXPECT_EQ(read("M117 50% done; X9").kind, GcodeLine::Kind::Command);
}

TEST(GcodeReader, TellsMalformedForeignAndUnreadableLinesApart) {
    EXPECT_EQ(read("G1 X--1").kind, GcodeLine::Kind::Malformed);
    EXPECT_EQ(read("G1 X.").kind, GcodeLine::Kind::Malformed);
    EXPECT_EQ(read("G1 X99999999999999999999999").kind, GcodeLine::Kind::Malformed);
    EXPECT_EQ(read("G1 X1 #3").kind, GcodeLine::Kind::Malformed);
    EXPECT_EQ(read("START_PRINT BED=60").kind, GcodeLine::Kind::Foreign);
    EXPECT_EQ(read("X10 Y10").kind, GcodeLine::Kind::Foreign);
    EXPECT_EQ(read("\x7f"
                   "ELF")
                  .kind,
              GcodeLine::Kind::Unreadable);
    EXPECT_EQ(read("\n").kind, GcodeLine::Kind::Empty);
    EXPECT_EQ(read("%").kind, GcodeLine::Kind::Empty);
}

TEST(GcodeReader, ALineOfTenMegabytesIsOneLine) {
    const std::string text =
        "G1 X" + std::string(10'000'000, '1') + "\n" + std::string(10'000'000, 'G') + "\nG28\n";
    const auto proof = prove(text);
    EXPECT_EQ(proof.figures.lines, 3);
}

TEST(Replay, KnowsAbsoluteAndRelativeFilamentInchesAndResets) {
    EXPECT_NEAR(extruded("M82\nG92 E0\n", "G1 X10 E1\nG1 X20 E2\n"), 2, 1e-9);
    EXPECT_NEAR(extruded("M83\n", "G1 X10 E1\nG1 X20 E1\n"), 2, 1e-9);
    EXPECT_NEAR(extruded("M82\nG92 E5\n", "G1 X10 E6\nG92 E0\nG1 X20 E1\n"), 2, 1e-9);
    EXPECT_NEAR(extruded("G20\nM83\n", "G1 X1 E0.1\n"), 2.54, 1e-9);
    EXPECT_NEAR(extruded("G91\n", "G1 X10 E1\nG1 X10 E1\n"), 2, 1e-9);
}

TEST(Replay, RetractionIsMadeGoodBeforeAnythingIsDeposited) {
    const auto proof = prove(
        "M104 S210\nM109 S210\nG28\nG1 X0 Y0 Z0.2 F600\nM83\nG1 X10 E1\nG1 E-2 F1800\nG1 X20 "
        "F7200\n"
        "G1 E2 F1800\nG1 X30 E1 F600\n");
    EXPECT_NEAR(proof.figures.filament_mm, 2, 1e-9);
    EXPECT_NEAR(proof.figures.blob_mm3, 0, 1e-9);
}

TEST(Replay, AnArcDepositsAlongItsChords) {
    // Half a circle of radius 10 about the origin, both ways of saying so.
    for (const char* arc :
         {"G3 X-10 Y0 I-10 J0 E1", "G3 X-10 Y0 R10 E1", "G2 X-10 Y0 I-10 J0 E1"}) {
        const auto proof = prove(
            std::string("M104 S210\nM109 S210\nG28\nG1 X10 Y0 Z0.2 F600\nM83\n") + arc + "\n");
        EXPECT_TRUE(proof.passed()) << arc;
        EXPECT_NEAR(proof.figures.filament_mm, 1, 1e-9) << arc;
    }
    EXPECT_FALSE(prove("G28\nG1 X10 Y0 Z0.2 F600\nG3 X-10 Y5 I-10 J0\n").passed());
}

TEST(Replay, HomingMakesThePositionUnknownUntilTheFrameIsBack) {
    cam::profile::FdmSetup setup = tests::proof_setup();
    setup.dialect.name = "sailfish";
    // G92 X118 lies outside the chamber, but the frame is not the machine's before M132.
    const std::string start =
        "G162 X Y F2500\nG161 Z F1100\nG92 X118 Y72.5 Z-5 A0 B0\nG1 Z0 F1100\nG161 Z F100\n"
        "M132 X Y Z A B\nM104 S210 T0\nM133 T0\nG90\nM83\n";
    EXPECT_TRUE(prove(start + "G1 X0 Y0 Z0.2 F1200\nG1 X10 E0.3\nM104 S0\n", setup).passed());
    const auto outside = prove(start + "G1 X118 Y0 Z0.2 F1200\n", setup);
    ASSERT_EQ(outside.faults.size(), 1U);
    EXPECT_EQ(outside.faults[0].code, "proof.outside_chamber");
    EXPECT_EQ(outside.faults[0].line, 11);
    const auto lost = prove(start + "G1 X10 E0.3 F600\n", setup);
    ASSERT_EQ(lost.faults.size(), 1U);
    EXPECT_EQ(lost.faults[0].code, "proof.unknown_position");
}

TEST(Replay, AnOffsetByG92MovesTheFrameNotTheNozzle) {
    const auto proof = prove("G28\nG1 X100 Y0 Z5 F600\nG92 X0\nG1 X10\nG1 X14\n");
    ASSERT_EQ(proof.faults.size(), 1U);
    EXPECT_EQ(proof.faults[0].code, "proof.outside_chamber");
    EXPECT_EQ(proof.faults[0].line, 5);
}

TEST(Replay, BytesThatAreNoGcodeAreAnErrorWithTheirLine) {
    const auto proof =
        cam::verify::examine("G28\n\x01\x02\x03\n", {}, tests::proof_setup(), {}, {});
    ASSERT_FALSE(proof.has_value());
    EXPECT_EQ(proof.error().code, "proof.unreadable");
    EXPECT_EQ(proof.error().where, "line 2");
}

TEST(Replay, ACancelledRunIsAnError) {
    std::stop_source source;
    source.request_stop();
    decomp::Run run;
    run.stop = source.get_token();
    const auto proof = cam::verify::examine(print_box({}).text, {}, tests::proof_setup(), {}, run);
    ASSERT_FALSE(proof.has_value());
    EXPECT_EQ(proof.error().code, "run.cancelled");
}

TEST(Replay, AMeshThatIsNotFiniteOrNotInTheChamberIsRefused) {
    cam::verify::PlacedPart part = box_part(tests::BoxPrint{});
    part.mesh.points[0].x() = std::nan("");
    EXPECT_EQ(cam::verify::examine("G28\n", {part}, tests::proof_setup(), {}, {}).error().code,
              "proof.bad_part");
    part.mesh.points[0].x() = 1e9;
    EXPECT_EQ(cam::verify::examine("G28\n", {part}, tests::proof_setup(), {}, {}).error().code,
              "proof.bad_part");
}

}  // namespace
