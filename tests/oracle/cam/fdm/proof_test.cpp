// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/oracle/cam/fdm/proof_of.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

/// The proof as an oracle of planning: it re-reads the program, slices the mesh by itself and
/// compares.
namespace {

using cam::verify::Proof;
using tests::box;
using tests::proof_of;
using tests::TriMesh;

/// Half a ball with waves, flat base, on the bed.
TriMesh wavy_dome(double radius, int waves, std::uint32_t around, std::uint32_t rings) {
    TriMesh mesh;
    mesh.points.emplace_back(0, 0, radius);
    for (std::uint32_t r = 1; r <= rings; ++r) {
        const double polar = std::numbers::pi / 2 * r / rings;
        for (std::uint32_t a = 0; a < around; ++a) {
            const double turn = 2 * std::numbers::pi * a / around;
            const double reach = radius * (1 + 0.06 * std::sin(waves * turn) *
                                                   std::sin(waves * polar) * std::sin(polar));
            mesh.points.emplace_back(reach * std::sin(polar) * std::cos(turn),
                                     reach * std::sin(polar) * std::sin(turn),
                                     r == rings ? 0 : reach * std::cos(polar));
        }
    }
    mesh.points.emplace_back(0, 0, 0);
    const auto at = [&](std::uint32_t ring, std::uint32_t a) {
        return 1 + ring * around + a % around;
    };
    const auto middle = static_cast<std::uint32_t>(mesh.points.size() - 1);
    for (std::uint32_t a = 0; a < around; ++a) {
        mesh.triangles.push_back({0, at(0, a), at(0, a + 1)});
        for (std::uint32_t r = 0; r + 1 < rings; ++r) {
            mesh.triangles.push_back({at(r, a), at(r + 1, a), at(r + 1, a + 1)});
            mesh.triangles.push_back({at(r, a), at(r + 1, a + 1), at(r, a + 1)});
        }
        mesh.triangles.push_back({middle, at(rings - 1, a + 1), at(rings - 1, a)});
    }
    return mesh;
}

TriMesh raised(TriMesh mesh, double by_mm) {
    for (auto& p : mesh.points) {
        p.z() += by_mm;
    }
    return mesh;
}

void expect_good(const Proof& proof) {
    for (const auto& fault : proof.faults) {
        ADD_FAILURE() << fault.code << " layer " << fault.layer << ": " << fault.text;
    }
    EXPECT_LE(proof.figures.uncovered_skin_percent, 0.05);
    EXPECT_LE(proof.figures.out_of_part_percent, 0.01);
    EXPECT_EQ(proof.figures.floating_islands, 0);
    if (proof.figures.solid_layers > 0) {
        EXPECT_NEAR(proof.figures.solid_fill_ratio, 1, 0.01);
    }
}

TEST(ProofOfPlan, ACube) { expect_good(proof_of(box({-20, -20, 0}, {20, 20, 40}))); }

TEST(ProofOfPlan, ACubeFullOfPlastic) {
    const auto proof = proof_of(box({-10, -10, 0}, {10, 10, 10}),
                                {"process.infill_density=1", "process.elephant_foot_mm=0"});
    expect_good(proof);
    EXPECT_EQ(proof.figures.solid_layers, 50);
}

/// The triangles of a mesh that lie at this x.
std::vector<bool> faces_at_x(const TriMesh& mesh, double x) {
    std::vector<bool> out;
    for (const auto& t : mesh.triangles) {
        out.push_back(std::all_of(t.begin(), t.end(),
                                  [&](std::uint32_t v) { return mesh.points[v].x() == x; }));
    }
    return out;
}

TEST(ProofOfPlan, AHalfWhoseSeamsLieOnItsCut) {
    const auto half = box({-20, -15, 0}, {10, 15, 12});
    const auto proof = proof_of(half, {"process.mating_gap_mm=0.2"}, faces_at_x(half, 10));
    EXPECT_TRUE(proof.passed());
    EXPECT_EQ(proof.figures.mating_walls, proof.figures.layers);
    EXPECT_GE(proof.figures.mating_seams_percent, 95);
}

TEST(ProofOfPlan, EveryPatternOfInfillAtManyDensities) {
    for (const char* pattern : {"rectilinear", "gyroid", "cubic", "grid", "concentric"}) {
        for (const char* density : {"0.05", "0.4"}) {
            expect_good(proof_of(box({-15, -15, 0}, {15, 15, 5}),
                                 {std::string("process.infill_pattern=") + pattern,
                                  std::string("process.infill_density=") + density}));
        }
    }
}

TEST(ProofOfPlan, CompensationsAreWhatTheProofExpects) {
    const auto plate = box({-15, -15, 0}, {15, 15, 5});
    for (const char* inset : {"0.1", "-0.1"}) {
        const auto proof = proof_of(plate, {"process.elephant_foot_mm=0.3",
                                            std::string("process.outline_inset_mm=") + inset});
        EXPECT_TRUE(proof.passed()) << inset;
    }
}

TEST(ProofOfPlan, AnArmOverTheBed) {
    // The arm shares no face with the mast: their slices are united.
    expect_good(proof_of(
        tests::joined(box({-20, -10, 0}, {0, 10, 30}), box({-20, -10, 30}, {25, 10, 40}))));
}

TEST(ProofOfPlan, APegThatHangsFromAnArm) {
    const auto gallows = tests::joined(box({0, 0, 0}, {10, 10, 30}), box({0, 0, 30}, {40, 10, 36}));
    expect_good(proof_of(tests::joined(gallows, box({30, 3, 20}, {34, 7, 30}))));
}

TEST(ProofOfPlan, APortalWithALongAndAShortSpan) {
    auto portal = tests::joined(box({-30, -8, 0}, {-20, 8, 12}), box({-12, -8, 0}, {-4, 8, 12}));
    portal = tests::joined(portal, box({26, -8, 0}, {34, 8, 12}));
    expect_good(proof_of(tests::joined(portal, box({-30, -8, 12}, {34, 8, 18}))));
}

TEST(ProofOfPlan, ADome) { expect_good(proof_of(wavy_dome(30, 6, 140, 36))); }

TEST(ProofOfPlan, ABallThatTouchesTheBedInAPoint) {
    expect_good(proof_of(raised(tests::sphere(15, 90, 59), 15)));
}

TEST(ProofOfPlan, ATorusStandingOnTheBedWithABrim) {
    auto ring = tests::torus(15, 5, 72, 36);
    for (auto& p : ring.points) {
        p = Eigen::Vector3d(p.x(), -p.z(), p.y() + 20);
    }
    expect_good(proof_of(ring, {"process.brim_width_mm=4"}));
}

TEST(ProofOfPlan, ThinWallsOfEveryWidth) {
    TriMesh walls;
    for (int i = 0; i < 12; ++i) {
        const double x = 4 * i - 24;
        walls = tests::joined(walls, box({x, -10, 0}, {x + 0.3 + 0.15 * i, 10, 4}));
    }
    const auto proof = proof_of(walls);
    for (const auto& fault : proof.faults) {
        ADD_FAILURE() << fault.code << " layer " << fault.layer << ": " << fault.text;
    }
    EXPECT_LE(proof.figures.uncovered_skin_percent, 0.05);
}

TEST(ProofOfPlan, AWebBetweenTwoBlocksReachesThem) {
    for (const double web : {0.35, 0.45, 0.6, 0.75}) {
        auto part = tests::joined(box({-10, -5, 0}, {-3, 5, 4}), box({3, -5, 0}, {10, 5, 4}));
        part = tests::joined(part, box({-3, -web / 2, 0}, {3, web / 2, 4}));
        const auto proof = proof_of(part, {"process.elephant_foot_mm=0"});
        expect_good(proof);
        EXPECT_EQ(proof.figures.uncovered_skin_percent, 0) << web;
    }
}

}  // namespace
