// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/cam/verify/print_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using cam::verify::Fault;
using cam::verify::PlacedPart;
using cam::verify::Proof;
using Eigen::Vector2d;
using tests::BoxPrint;
using tests::BoxWriter;

constexpr int kCorners = 96;
constexpr double kOuterMm = 12;

Vector2d on_circle(double radius, int corner) {
    const double turn = 2 * std::numbers::pi * corner / kCorners;
    return {radius * std::cos(turn), radius * std::sin(turn)};
}

/// A plate with a round hole in its middle.
tests::TriMesh washer(double hole_radius, double height) {
    tests::TriMesh mesh;
    for (const double z : {0.0, height}) {
        for (const double r : {hole_radius, kOuterMm}) {
            for (int i = 0; i < kCorners; ++i) {
                const Vector2d p = on_circle(r, i);
                mesh.points.emplace_back(p.x(), p.y(), z);
            }
        }
    }
    const auto at = [](int z, int ring, int i) {
        return static_cast<std::uint32_t>((z * 2 + ring) * kCorners + i % kCorners);
    };
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    for (int i = 0; i < kCorners; ++i) {
        quad(at(0, 1, i), at(0, 1, i + 1), at(1, 1, i + 1), at(1, 1, i));
        quad(at(0, 0, i + 1), at(0, 0, i), at(1, 0, i), at(1, 0, i + 1));
        quad(at(1, 0, i), at(1, 1, i), at(1, 1, i + 1), at(1, 0, i + 1));
        quad(at(0, 0, i), at(0, 0, i + 1), at(0, 1, i + 1), at(0, 1, i));
    }
    return mesh;
}

/// Circles that fill the washer, the hole printed with a radius of its own.
std::string print_washer(double hole_radius, int layers) {
    BoxWriter out;
    for (const char* words :
         {"G21", "G90", "M140 S60", "M104 S215", "M190 S60", "M109 S215", "G28", "M82", "G92 E0"}) {
        out.put(words);
    }
    for (int layer = 0; layer < layers; ++layer) {
        out.put_numbers("G1 Z%.3f F600", 0.2 * (layer + 1));
        const int rings = 20;
        const double spacing = (kOuterMm - hole_radius) / rings;
        for (int k = 0; k < rings; ++k) {
            out.put(k == 0 || k == rings - 1 ? ";TYPE:outer-wall" : ";TYPE:solid-infill");
            const double radius = hole_radius + (k + 0.5) * spacing;
            out.travel(on_circle(radius, 0));
            for (int i = 1; i <= kCorners; ++i) {
                out.bead(on_circle(radius, i % kCorners), spacing, 0.2, 30);
            }
        }
    }
    for (const char* words : {"M104 S0", "M140 S0", "M84"}) {
        out.put(words);
    }
    return out.text;
}

Proof prove(const std::string& text, const std::vector<PlacedPart>& parts,
            const cam::profile::FdmSetup& setup) {
    auto proof = cam::verify::examine(text, parts, setup, {}, {});
    EXPECT_TRUE(proof.has_value()) << (proof ? "" : proof.error().text());
    return proof ? *proof : Proof{};
}

/// As the box printer means it: nothing taken off, nothing added.
cam::profile::FdmSetup plain_setup() {
    auto setup = tests::proof_setup();
    setup.machine.process.hole_growth_mm = 0;
    setup.machine.process.elephant_foot_mm = 0;
    return setup;
}

bool has(const Proof& proof, const std::string& code) {
    return std::any_of(proof.faults.begin(), proof.faults.end(),
                       [&](const Fault& fault) { return fault.code == code; });
}

TEST(HoleProof, ARightHoleIsMeasuredToAFewHundredths) {
    for (const double radius : {1.5, 2.0, 4.0}) {
        const Proof proof =
            prove(print_washer(radius, 10), {{"P01", washer(radius, 2), {}}}, plain_setup());
        EXPECT_TRUE(proof.passed());
        EXPECT_EQ(proof.figures.round_holes, 10);
        EXPECT_NEAR(proof.figures.hole_error_mm, 0, 0.06) << radius;
    }
}

TEST(HoleProof, ANarrowHoleIsTold) {
    const Proof proof = prove(print_washer(1.75, 10), {{"P01", washer(2, 2), {}}}, plain_setup());
    EXPECT_TRUE(has(proof, "proof.hole_diameter"));
    EXPECT_NEAR(proof.figures.worst_hole_error_mm, -0.5, 0.08);
}

TEST(HoleProof, TheGrowthOfTheProfileIsAskedFor) {
    auto setup = plain_setup();
    setup.machine.process.hole_growth_mm = 0.1;
    const Proof wide = prove(print_washer(2.1, 10), {{"P01", washer(2, 2), {}}}, setup);
    EXPECT_NEAR(wide.figures.hole_error_mm, 0, 0.06);
    EXPECT_TRUE(wide.passed());
    const Proof drawn = prove(print_washer(2, 10), {{"P01", washer(2, 2), {}}}, setup);
    EXPECT_NEAR(drawn.figures.hole_error_mm, -0.2, 0.06);
}

TEST(FootProof, AFootWithoutItsMiddleIsTold) {
    BoxPrint print;
    print.relative_e = true;
    const std::string good = print_box(print).text;
    const Proof whole = prove(good, {box_part(print)}, plain_setup());
    EXPECT_NEAR(whole.figures.first_layer_mm2, 400, 3);
    EXPECT_NEAR(whole.figures.first_layer_percent, 100, 0.5);
    // The first layer has only its outermost loops.
    std::string hollow;
    long loops = 0;
    std::size_t at = 0;
    while (at < good.size()) {
        const std::size_t end = good.find('\n', at) + 1;
        const std::string line = good.substr(at, end - at);
        loops += line.starts_with(";TYPE") ? 1 : 0;
        const bool kept = loops <= 8 || loops > 25;
        hollow += kept || !line.starts_with("G1 X") ? line : std::string();
        at = end;
    }
    const Proof proof = prove(hollow, {box_part(print)}, plain_setup());
    EXPECT_TRUE(has(proof, "proof.first_layer"));
    EXPECT_LT(proof.figures.first_layer_percent, 65);
}

TEST(SeamProof, SeamsAreCountedOnTheFaceThatTouchesAnotherPart) {
    // Every square of the box begins at its lower left corner.
    const BoxPrint print;
    const std::string text = print_box(print).text;
    for (const double side : {-10.0, 10.0}) {
        PlacedPart part = box_part(print);
        for (const auto& t : part.mesh.triangles) {
            part.mating.push_back(std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
                return part.mesh.points[v].x() == side;
            }));
        }
        const Proof proof = prove(text, {part}, plain_setup());
        EXPECT_EQ(proof.figures.outer_walls, 20);
        EXPECT_EQ(proof.figures.mating_walls, 20);
        EXPECT_EQ(proof.figures.mating_seams_percent, side < 0 ? 100 : 0);
    }
}

/// A solid box on a block of support, with free layers between them.
std::string print_over_support(int free_layers) {
    BoxWriter out;
    for (const char* words :
         {"G21", "G90", "M140 S60", "M104 S215", "M190 S60", "M109 S215", "G28", "M82", "G92 E0"}) {
        out.put(words);
    }
    constexpr int kSupportLayers = 10;
    for (int layer = 0; layer < 2 * kSupportLayers + free_layers; ++layer) {
        const bool support = layer < kSupportLayers;
        if (!support && layer < kSupportLayers + free_layers) {
            continue;
        }
        out.put_numbers("G1 Z%.3f F600", 0.2 * (layer + 1));
        for (int k = 0; k < 25; ++k) {
            out.put(support ? ";TYPE:support"
                            : (k == 0 ? ";TYPE:outer-wall" : ";TYPE:solid-infill"));
            out.square(Vector2d::Zero(), 10 - (k + 0.5) * 0.4, 0.4, 0.2, 30);
        }
    }
    for (const char* words : {"M104 S0", "M140 S0", "M84"}) {
        out.put(words);
    }
    return out.text;
}

TEST(SupportProof, APartThatNoLongerTouchesItsSupportIsTold) {
    for (const int free_layers : {1, 2, 4}) {
        const double bottom = 2 + 0.2 * free_layers;
        const Proof proof = prove(
            print_over_support(free_layers),
            {{"P01", tests::box({-10, -10, bottom}, {10, 10, bottom + 2}), {}}}, plain_setup());
        EXPECT_EQ(has(proof, "proof.floating_island"), free_layers > 2) << free_layers;
        EXPECT_NEAR(proof.figures.support_contact_mm2, free_layers > 2 ? 0 : 400, 8) << free_layers;
    }
}

}  // namespace
