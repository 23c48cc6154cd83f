// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/cam/verify/print_box.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using cam::verify::Fault;
using cam::verify::Proof;
using tests::BoxPrint;
using tests::BoxWriter;
using tests::PrintedBox;

Proof prove(const PrintedBox& printed, const std::vector<cam::verify::PlacedPart>& parts,
            const cam::profile::FdmSetup& setup = tests::proof_setup(), int jobs = 1) {
    decomp::Run run;
    run.jobs = jobs;
    auto proof = cam::verify::examine(printed.text, parts, setup, {}, run);
    EXPECT_TRUE(proof.has_value()) << (proof ? "" : proof.error().text());
    return proof ? *proof : Proof{};
}

std::string told(const Proof& proof) {
    std::string out;
    for (const Fault& fault : proof.faults) {
        out += fault.code + " line " + std::to_string(fault.line) + " layer " +
               std::to_string(fault.layer) + ": " + fault.text + "\n";
    }
    return out;
}

const Fault* find(const Proof& proof, const std::string& code) {
    const auto at = std::find_if(proof.faults.begin(), proof.faults.end(),
                                 [&](const Fault& fault) { return fault.code == code; });
    return at == proof.faults.end() ? nullptr : &*at;
}

/// The fault is there, and points into this layer of the program.
void expect_fault(const Proof& proof, const std::string& code, const PrintedBox& printed,
                  int layer) {
    const Fault* fault = find(proof, code);
    ASSERT_NE(fault, nullptr) << code << " is missing among\n" << told(proof);
    EXPECT_EQ(fault->layer, layer) << told(proof);
    EXPECT_GE(fault->line, printed.layer_lines[static_cast<std::size_t>(layer)]) << told(proof);
    EXPECT_LT(fault->line, printed.layer_lines[static_cast<std::size_t>(layer) + 1]) << told(proof);
}

TEST(SeededFault, AGoodBoxPassesWithItsFigures) {
    for (const bool relative : {false, true}) {
        BoxPrint print;
        print.relative_e = relative;
        const Proof proof = prove(print_box(print), {box_part(print)});
        EXPECT_TRUE(proof.passed()) << told(proof);
        EXPECT_EQ(proof.figures.layers, 20);
        EXPECT_NEAR(proof.figures.extruded_mm3, 20 * 20 * 4, 0.5);
        EXPECT_NEAR(proof.figures.filament_mm, 1600 / 2.40528, 0.5);
        EXPECT_NEAR(proof.figures.solid_fill_ratio, 1, 0.005);
        EXPECT_EQ(proof.figures.uncovered_skin_percent, 0);
        EXPECT_EQ(proof.figures.out_of_part_mm3, 0);
        EXPECT_NEAR(proof.figures.max_flow_mm3_per_s, 0.4 * 0.2 * 40, 0.05);
    }
}

TEST(SeededFault, ALayerWithoutExtrusionIsMissedAndItsFilamentIsABlob) {
    BoxPrint print;
    print.before = [](BoxWriter& out, int layer) { out.dry = layer == 8; };
    print.after = [](BoxWriter& out, int layer) {
        if (layer == 8) {
            out.e += 33;  // the absolute E of the next move holds what the layer should have used
            out.put_numbers("G1 E%.5f F2400", out.e);
        }
    };
    const PrintedBox printed = print_box(print);
    const Proof proof = prove(printed, {box_part(print)});
    expect_fault(proof, "proof.missing_layer", printed, 8);
    EXPECT_NE(find(proof, "proof.missing_layer")->text.find("between z 1.6 and 1.8 mm"),
              std::string::npos)
        << told(proof);
    ASSERT_NE(find(proof, "proof.blob"), nullptr) << told(proof);
    EXPECT_NEAR(proof.figures.blob_mm3, 33 * 2.40528, 0.1);
}

TEST(SeededFault, AShiftOfHalfAMillimetreIsOutsideThePartAndBaresItsSkin) {
    BoxPrint print;
    print.before = [](BoxWriter& out, int layer) {
        if (layer == 6) {
            out.shift = {0.5, 0};
        }
    };
    const PrintedBox printed = print_box(print);
    const Proof proof = prove(printed, {box_part(print)});
    expect_fault(proof, "proof.outside_part", printed, 6);
    expect_fault(proof, "proof.uncovered_skin", printed, 6);
}

TEST(SeededFault, ANozzleThatDivesIntoThePartIsBelowPrintedMaterial) {
    BoxPrint print;
    print.before = [](BoxWriter& out, int layer) {
        if (layer == 12) {
            out.put("G1 Z1.000");
            out.put("G1 Z2.600");
        }
    };
    const PrintedBox printed = print_box(print);
    const Proof proof = prove(printed, {box_part(print)});
    const Fault* fault = find(proof, "proof.below_printed");
    ASSERT_NE(fault, nullptr) << told(proof);
    EXPECT_EQ(fault->line, printed.layer_lines[12] + 1);
    EXPECT_EQ(fault->layer, 12);
    EXPECT_EQ(proof.figures.moves_below_printed, 1);
}

TEST(SeededFault, AMoveOutOfTheChamberIsToldWithItsLine) {
    BoxPrint print;
    print.before = [](BoxWriter& out, int layer) {
        if (layer == 3) {
            out.put("G1 X130 Y0");
        }
    };
    const PrintedBox printed = print_box(print);
    const Proof proof = prove(printed, {box_part(print)});
    expect_fault(proof, "proof.outside_chamber", printed, 3);
    EXPECT_EQ(find(proof, "proof.outside_chamber")->line, printed.layer_lines[3] + 1);
    EXPECT_EQ(proof.figures.moves_outside_chamber, 1);
    EXPECT_EQ(proof.faults.size(), 1U) << told(proof);
}

TEST(SeededFault, FiveTimesTheSpeedIsTooMuchFlow) {
    BoxPrint print;
    print.before = [](BoxWriter& out, int layer) { out.speed = layer == 5 ? 5 : 1; };
    const PrintedBox printed = print_box(print);
    const Proof proof = prove(printed, {box_part(print)});
    expect_fault(proof, "proof.flow", printed, 5);
    EXPECT_NEAR(proof.figures.max_flow_mm3_per_s, 16, 0.2);
}

TEST(SeededFault, TenPerCentTooMuchFilamentOverfillsSolidLayers) {
    BoxPrint print;
    print.before = [](BoxWriter& out, int) { out.flow = 1.1; };
    const PrintedBox printed = print_box(print);
    const Proof proof = prove(printed, {box_part(print)});
    expect_fault(proof, "proof.overfilled", printed, 0);
    EXPECT_NEAR(proof.figures.solid_fill_ratio, 1.1, 0.01);
}

TEST(SeededFault, AHangingPegIsAFloatingIsland) {
    BoxPrint print;
    print.after = [](BoxWriter& out, int layer) {
        if (layer >= 10) {
            for (int k = 0; k < 3; ++k) {
                out.square({25, 0}, 1.4 - 0.4 * k - 0.2, 0.4, 0.2, 30);
            }
        }
    };
    cam::verify::PlacedPart part = box_part(print);
    part.mesh = tests::joined(part.mesh, tests::box({23.6, -1.4, 2.0}, {26.4, 1.4, 4.0}));
    const PrintedBox printed = print_box(print);
    const Proof proof = prove(printed, {part});
    expect_fault(proof, "proof.floating_island", printed, 10);
    EXPECT_EQ(proof.figures.floating_islands, 1);
}

TEST(SeededFault, AShelfOverNothingIsUnsupportedAndABridgeIsNot) {
    // A shelf of 12 mm sticks out of the box; its loops are connected with it, so it is no island.
    BoxPrint shelf;
    shelf.after = [](BoxWriter& out, int layer) {
        if (layer >= 10) {
            for (int k = 0; k < 15; ++k) {
                out.square({16, 0}, 6 - 0.4 * k - 0.2, 0.4, 0.2, 30);
            }
        }
    };
    cam::verify::PlacedPart part = box_part(shelf);
    part.mesh = tests::joined(part.mesh, tests::box({10, -6, 2}, {22, 6, 4}));
    const PrintedBox hangs = print_box(shelf);
    const Proof bad = prove(hangs, {part});
    expect_fault(bad, "proof.unsupported", hangs, 10);
    EXPECT_EQ(bad.figures.floating_islands, 0);
    EXPECT_EQ(bad.faults.size(), 1U) << told(bad);

    // The same gap closed by straight beads from the box to a second one.
    BoxPrint bridge;
    bridge.after = [](BoxWriter& out, int layer) {
        for (int k = 0; k < 10; ++k) {
            out.square({26, 0}, 4 - 0.4 * k - 0.2, 0.4, 0.2, 30);
        }
        for (int k = 0; layer >= 10 && k < 20; ++k) {
            out.travel({10, -3.8 + 0.4 * k});
            out.bead({16, -3.8 + 0.4 * k}, 0.4, 0.2, 30);
            out.bead({22, -3.8 + 0.4 * k}, 0.4, 0.2, 30);
        }
    };
    cam::verify::PlacedPart table = box_part(bridge);
    table.mesh = tests::joined(tests::joined(table.mesh, tests::box({22, -4, 0}, {30, 4, 4})),
                               tests::box({10, -4, 2}, {22, 4, 4}));
    const Proof good = prove(print_box(bridge), {table});
    EXPECT_EQ(find(good, "proof.unsupported"), nullptr) << told(good);
    EXPECT_EQ(good.figures.hanging_mm2, 0);
}

TEST(SeededFault, ExtrudingBeforeTheNozzleIsHotIsCold) {
    BoxPrint print;
    PrintedBox printed = print_box(print);
    const std::size_t wait = printed.text.find("M109 S215\n");
    printed.text.replace(wait, 9, "M105     ");
    const Proof proof = prove(printed, {box_part(print)});
    ASSERT_NE(find(proof, "proof.cold_extrusion"), nullptr) << told(proof);
    EXPECT_EQ(find(proof, "proof.cold_extrusion")->line, printed.layer_lines[0] + 3);
}

TEST(SeededFault, AnUnknownCommandIsAFaultOfOursAndANoteForAStranger) {
    BoxPrint print;
    print.before = [](BoxWriter& out, int layer) {
        if (layer == 2) {
            out.put("M9876 S1");
        }
    };
    const PrintedBox printed = print_box(print);
    const Proof ours = prove(printed, {box_part(print)});
    ASSERT_NE(find(ours, "proof.unknown_command"), nullptr);
    EXPECT_EQ(find(ours, "proof.unknown_command")->line, printed.layer_lines[2] + 1);
    const auto theirs = cam::verify::examine(printed.text, {box_part(print)}, tests::proof_setup(),
                                             {.strangers_program = true}, {});
    ASSERT_TRUE(theirs.has_value());
    EXPECT_TRUE(theirs->passed()) << told(*theirs);
    EXPECT_EQ(theirs->notes.size(), 1U);
}

TEST(SeededFault, AForbiddenWordOfTheDialectIsAFault) {
    BoxPrint print;
    cam::profile::FdmSetup setup = tests::proof_setup();
    setup.dialect.forbidden = {"M109"};
    const Proof proof = prove(print_box(print), {box_part(print)}, setup);
    ASSERT_NE(find(proof, "proof.forbidden_word"), nullptr);
    EXPECT_EQ(find(proof, "proof.forbidden_word")->line, 6);
}

TEST(SeededFault, APartThatTheProgramForgetsIsToldByName) {
    BoxPrint print;
    cam::verify::PlacedPart second = box_part(print);
    second.id = "P02";
    for (auto& point : second.mesh.points) {
        point.x() += 40;
    }
    const Proof proof = prove(print_box(print), {box_part(print), second});
    ASSERT_NE(find(proof, "proof.missing_part"), nullptr) << told(proof);
    EXPECT_NE(find(proof, "proof.missing_part")->text.find("P02"), std::string::npos);
}

TEST(SeededFault, OnAPlateOfTwoTheLayerThatOneOfThemLacksIsToldByName) {
    BoxPrint print;
    print.half_mm = 8;
    print.loops = 20;
    print.after = [](BoxWriter& out, int layer) {
        for (int k = 0; layer != 9 && k < 20; ++k) {
            out.square({40, 0}, 8 - 0.4 * k - 0.2, 0.4, 0.2, 40);
        }
    };
    BoxPrint second = print;
    second.centre = {40, 0};
    cam::verify::PlacedPart other = box_part(second);
    other.id = "P02";
    const PrintedBox printed = print_box(print);
    const Proof proof = prove(printed, {box_part(print), other});
    ASSERT_EQ(proof.faults.size(), 1U) << told(proof);
    EXPECT_EQ(proof.faults[0].code, "proof.missing_layer");
    EXPECT_NE(proof.faults[0].text.find("P02"), std::string::npos);
    EXPECT_NE(proof.faults[0].text.find("between z 1.8 and 2 mm"), std::string::npos)
        << told(proof);
}

TEST(SeededFault, ACoverTheProgramForgetsIsAMissingLayerAtTheTop) {
    BoxPrint print;
    cam::verify::PlacedPart taller = box_part(print);
    for (auto& point : taller.mesh.points) {
        point.z() = point.z() > 1 ? 5 : 0;
    }
    const Proof proof = prove(print_box(print), {taller});
    ASSERT_NE(find(proof, "proof.missing_layer"), nullptr) << told(proof);
    EXPECT_EQ(find(proof, "proof.missing_layer")->layer, 20);
}

TEST(SeededFault, SupportsAreNoExcuseForAPartThatIsNotThere) {
    // Everything declared as support: the part itself is then not made.
    BoxPrint print;
    PrintedBox printed = print_box(print);
    for (std::size_t at = 0;
         (at = printed.text.find(";TYPE:outer-wall", at)) != std::string::npos;) {
        printed.text.replace(at, 16, ";TYPE:support   ");
    }
    for (std::size_t at = 0;
         (at = printed.text.find(";TYPE:solid-infill", at)) != std::string::npos;) {
        printed.text.replace(at, 18, ";TYPE:support     ");
    }
    const Proof proof = prove(printed, {box_part(print)});
    ASSERT_NE(find(proof, "proof.missing_part"), nullptr) << told(proof);
}

TEST(SeededFault, TheProofDoesNotDependOnTheNumberOfThreads) {
    BoxPrint print;
    print.before = [](BoxWriter& out, int layer) { out.shift = {layer >= 6 ? 0.5 : 0, 0}; };
    const PrintedBox printed = print_box(print);
    const Proof one = prove(printed, {box_part(print)}, tests::proof_setup(), 1);
    const Proof four = prove(printed, {box_part(print)}, tests::proof_setup(), 4);
    EXPECT_EQ(told(one), told(four));
    EXPECT_EQ(one.figures.out_of_part_mm3, four.figures.out_of_part_mm3);
    EXPECT_EQ(one.figures.uncovered_skin_percent, four.figures.uncovered_skin_percent);
}

TEST(CheckedProgram, IsOnlyMadeFromAProgramThatPasses) {
    BoxPrint print;
    const PrintedBox printed = print_box(print);
    const auto good =
        cam::verify::check(printed.text, {box_part(print)}, tests::proof_setup(), {}, {});
    ASSERT_TRUE(good.has_value());
    EXPECT_EQ(good->text(), printed.text);
    EXPECT_EQ(good->hash().size(), 64U);
    print.before = [](BoxWriter& out, int) { out.flow = 1.2; };
    const auto bad =
        cam::verify::check(print_box(print).text, {box_part(print)}, tests::proof_setup(), {}, {});
    ASSERT_FALSE(bad.has_value());
    EXPECT_EQ(bad.error().code, "proof.failed");
    EXPECT_FALSE(bad.error().notes.empty());
}

}  // namespace
