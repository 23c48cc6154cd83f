// SPDX-License-Identifier: GPL-3.0-or-later
// The checker against slicers that share nothing with it: their good programs pass, the same
// programs with a seeded fault do not.
#include "cam/verify/verify.h"
#include "tests/oracle/cam/verify/peers.h"
#include "tests/unit/cam/verify/print_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <sstream>

namespace {

using cam::verify::Fault;
using cam::verify::Proof;
using tests::TriMesh;

Proof prove(const std::string& text, const TriMesh& mesh) {
    cam::profile::FdmSetup setup = tests::proof_setup();
    setup.dialect.name = "sailfish";
    setup.dialect.forbidden = {"M109"};
    decomp::Run run;
    run.jobs = 2;
    auto proof =
        cam::verify::examine(text, {{"P01", mesh}}, setup, {.strangers_program = true}, run);
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

struct Shape {
    const char* name;
    TriMesh mesh;
};

std::vector<Shape> shapes() {
    return {{"cube", tests::box({0, 0, 0}, {40, 40, 40})},
            {"l-block", tests::l_block()},
            {"dome-10k", tests::bumpy_dome(140, 36, 50, 0.06, 6)},
            {"dome-70k", tests::bumpy_dome(370, 95, 50, 0.06, 9)}};
}

void expect_good(const std::optional<std::string>& program, const Shape& shape) {
    const Proof proof = prove(*program, tests::centred(shape.mesh));
    EXPECT_TRUE(proof.passed()) << told(proof);
    EXPECT_EQ(proof.figures.uncovered_skin_percent, 0);
    EXPECT_LT(proof.figures.out_of_part_percent, 0.002);
    EXPECT_GT(proof.figures.solid_fill_ratio, 0.995);
    EXPECT_LT(proof.figures.solid_fill_ratio, 1.012);
    EXPECT_EQ(proof.figures.floating_islands, 0);
    EXPECT_EQ(proof.figures.moves_below_printed, 0);
    EXPECT_EQ(proof.figures.moves_outside_chamber, 0);
    EXPECT_LT(proof.figures.blob_mm3, 0.1);
}

TEST(Peer, ProgramsOfPrusaSlicerPass) {
    for (const Shape& shape : shapes()) {
        SCOPED_TRACE(shape.name);
        const auto program = tests::prusa_program(shape.name, shape.mesh);
        if (!program) {
            GTEST_SKIP() << "prusa-slicer is not installed or does not run";
        }
        expect_good(program, shape);
    }
}

TEST(Peer, ProgramsOfCuraEnginePass) {
    for (const Shape& shape : shapes()) {
        SCOPED_TRACE(shape.name);
        const auto program = tests::cura_program(shape.name, shape.mesh);
        if (!program) {
            GTEST_SKIP() << "CuraEngine or the definitions of the package cura are missing";
        }
        expect_good(program, shape);
    }
}

/// A prism along Y over a polygon of the XZ plane, given with its triangles.
TriMesh prism(const std::vector<std::array<double, 2>>& corners,
              const std::vector<std::array<std::uint32_t, 3>>& face) {
    TriMesh mesh;
    const auto count = static_cast<std::uint32_t>(corners.size());
    for (const double y : {0.0, 30.0}) {
        for (const auto& [x, z] : corners) {
            mesh.points.emplace_back(x, y, z);
        }
    }
    for (const auto& t : face) {
        mesh.triangles.push_back(t);
        mesh.triangles.push_back({t[0] + count, t[2] + count, t[1] + count});
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t j = (i + 1) % count;
        mesh.triangles.push_back({i, i + count, j + count});
        mesh.triangles.push_back({i, j + count, j});
    }
    return mesh;
}

TEST(Peer, ABridgedTablePassesAndAShelfWithoutSupportsDoesNot) {
    const TriMesh table =
        prism({{0, 0}, {10, 0}, {10, 15}, {30, 15}, {30, 0}, {40, 0}, {40, 20}, {0, 20}},
              {{0, 1, 2}, {0, 2, 7}, {2, 3, 7}, {3, 6, 7}, {3, 4, 5}, {3, 5, 6}});
    const TriMesh tee =
        prism({{20, 0}, {30, 0}, {30, 20}, {50, 20}, {50, 26}, {0, 26}, {0, 20}, {20, 20}},
              {{0, 1, 2}, {0, 2, 7}, {7, 2, 3}, {7, 3, 4}, {7, 4, 5}, {7, 5, 6}});
    const auto bridged = tests::prusa_program("table", table);
    const auto shelf = tests::prusa_program("tee", tee);
    if (!bridged || !shelf) {
        GTEST_SKIP() << "prusa-slicer is not installed or does not run";
    }
    const Proof good = prove(*bridged, tests::centred(table));
    EXPECT_TRUE(good.passed()) << told(good);
    const Proof bad = prove(*shelf, tests::centred(tee));
    ASSERT_EQ(bad.faults.size(), 1U) << told(bad);
    EXPECT_EQ(bad.faults[0].code, "proof.unsupported");
    EXPECT_EQ(bad.faults[0].layer, 100);
}

/// A program as lines, with the range of each layer.
struct Program {
    std::vector<std::string> lines;
    std::vector<std::size_t> starts;  ///< index of each layer's first line, and of the end

    explicit Program(const std::string& text) {
        std::istringstream stream(text);
        for (std::string line; std::getline(stream, line);) {
            if (line == ";LAYER_CHANGE") {
                starts.push_back(lines.size());
            }
            lines.push_back(line);
        }
        starts.push_back(lines.size());
    }

    [[nodiscard]] std::string text() const {
        std::string out;
        for (const std::string& line : lines) {
            out += line + "\n";
        }
        return out;
    }

    /// Index of a line in the middle of a layer, after a bead.
    [[nodiscard]] std::size_t bead_in(std::size_t layer) const {
        std::size_t at = (starts[layer] + starts[layer + 1]) / 2;
        while (lines[at].find(" E") == std::string::npos ||
               lines[at].find('X') == std::string::npos) {
            ++at;
        }
        return at;
    }
};

/// Replaces the number after `letter` by change(number).
void change_word(std::string& line, char letter, const std::function<double(double)>& change) {
    const std::size_t comment = line.find(';');
    const std::size_t at = line.find(letter, 1);
    if (at == std::string::npos || at > comment || !line.starts_with("G1 ")) {
        return;
    }
    std::size_t end = at + 1;
    while (end < line.size() && line[end] != ' ') {
        ++end;
    }
    char number[40];
    std::snprintf(number, sizeof number, "%.5f",
                  change(std::stod(line.substr(at + 1, end - at - 1))));
    line = line.substr(0, at + 1) + number + line.substr(end);
}

void expect_fault(const Proof& proof, const std::string& code, std::size_t first_line,
                  std::size_t last_line) {
    const auto at = std::find_if(proof.faults.begin(), proof.faults.end(),
                                 [&](const Fault& f) { return f.code == code; });
    ASSERT_NE(at, proof.faults.end()) << code << " is missing among\n" << told(proof);
    EXPECT_GE(at->line, static_cast<long>(first_line)) << told(proof);
    EXPECT_LE(at->line, static_cast<long>(last_line)) << told(proof);
}

class SeededDome : public testing::Test {
  protected:
    void SetUp() override {
        const auto text =
            tests::prusa_program("seeded-dome", tests::bumpy_dome(140, 36, 50, 0.06, 6));
        if (!text) {
            GTEST_SKIP() << "prusa-slicer is not installed or does not run";
        }
        good = Program(*text);
    }

    /// 1-based lines of a layer.
    [[nodiscard]] std::size_t first(std::size_t layer) const { return good.starts[layer] + 1; }

    [[nodiscard]] std::size_t last(std::size_t layer) const { return good.starts[layer + 1]; }

    Program good{""};
    TriMesh mesh = tests::centred(tests::bumpy_dome(140, 36, 50, 0.06, 6));
};

TEST_F(SeededDome, EachOfSevenFaultsIsCaughtWithItsLine) {
    {
        SCOPED_TRACE("a layer without extrusion");
        Program bad = good;
        for (std::size_t k = bad.starts[40]; k < bad.starts[41]; ++k) {
            std::string& line = bad.lines[k];
            if (line.starts_with("G1 X")) {
                line = line.substr(0, line.find(" E"));
            }
        }
        const Proof proof = prove(bad.text(), mesh);
        expect_fault(proof, "proof.missing_layer", first(40), last(40));
        // The filament of the whole layer comes with the next push on the spot, at its end or the
        // start of layer 41.
        expect_fault(proof, "proof.blob", first(40), first(41) + 20);
        EXPECT_GT(proof.figures.blob_mm3, 250);
    }
    {
        SCOPED_TRACE("X shifted by half a millimetre from layer 60");
        Program bad = good;
        for (std::size_t k = bad.starts[60]; k < bad.lines.size(); ++k) {
            change_word(bad.lines[k], 'X', [](double x) { return x + 0.5; });
        }
        const Proof proof = prove(bad.text(), mesh);
        expect_fault(proof, "proof.outside_part", first(60), last(60));
        expect_fault(proof, "proof.uncovered_skin", first(60), last(60));
        EXPECT_GT(proof.figures.out_of_part_mm3, 500);
    }
    {
        SCOPED_TRACE("the nozzle dives into the part");
        Program bad = good;
        const std::size_t at = bad.bead_in(100) + 1;
        bad.lines.insert(bad.lines.begin() + static_cast<long>(at), {"G1 Z5", "G1 Z20.2"});
        const Proof proof = prove(bad.text(), mesh);
        expect_fault(proof, "proof.below_printed", at + 1, at + 1);
        EXPECT_EQ(proof.faults.size(), 1U) << told(proof);
    }
    {
        SCOPED_TRACE("a move to X130");
        Program bad = good;
        const std::size_t at = bad.starts[30] + 8;
        bad.lines.insert(bad.lines.begin() + static_cast<long>(at), "G1 X130");
        const Proof proof = prove(bad.text(), mesh);
        expect_fault(proof, "proof.outside_chamber", at + 1, at + 1);
    }
    {
        SCOPED_TRACE("five times the speed on a layer");
        Program bad = good;
        for (std::size_t k = bad.starts[50]; k < bad.starts[51]; ++k) {
            change_word(bad.lines[k], 'F', [](double f) { return f * 5; });
        }
        const Proof proof = prove(bad.text(), mesh);
        expect_fault(proof, "proof.flow", first(50), last(50));
        EXPECT_GT(proof.figures.max_flow_mm3_per_s, 20);
    }
    {
        SCOPED_TRACE("ten per cent more filament");
        Program bad = good;
        for (std::string& line : bad.lines) {
            change_word(line, 'E', [](double e) { return e * 1.1; });
        }
        const Proof proof = prove(bad.text(), mesh);
        expect_fault(proof, "proof.overfilled", first(0), last(0));
        EXPECT_NEAR(proof.figures.solid_fill_ratio, 1.104, 0.006);
    }
    {
        SCOPED_TRACE("a hanging peg without support");
        Program bad = good;
        for (std::size_t layer = 80; layer-- > 70;) {
            const std::size_t at = bad.bead_in(layer);
            tests::BoxWriter peg;
            peg.relative_e = true;
            peg.put("M83");
            for (int ring = 0; ring < 4; ++ring) {
                peg.square({70, 0}, 1.6 - 0.4 * ring - 0.2, 0.4, 0.2, 30);
            }
            peg.put("M82");
            const std::string& bead = bad.lines[at];
            peg.put("G92 " + bead.substr(bead.find(" E") + 1));
            peg.put(bead.substr(0, bead.find(" E")));
            bad.lines.insert(bad.lines.begin() + static_cast<long>(at) + 1,
                             peg.text.substr(0, peg.text.size() - 1));
        }
        const TriMesh with_peg = tests::joined(mesh, tests::box({68.4, -1.6, 14}, {71.6, 1.6, 16}));
        const Proof proof = prove(bad.text(), with_peg);
        expect_fault(proof, "proof.floating_island", good.bead_in(70) + 2, good.bead_in(70) + 20);
        EXPECT_EQ(proof.figures.floating_islands, 1);
    }
}

}  // namespace
