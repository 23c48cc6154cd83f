// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/repair.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/intersect.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using decomp::mesh::TriMesh;
using decomp::repair::repair;
using decomp::repair::Repaired;
using decomp::repair::Status;

/// Repairs and checks what every result must be.
Repaired repaired(const TriMesh& soup) {
    const auto result = repair(soup, {}, decomp::Run{});
    EXPECT_TRUE(result) << result.error().text();
    if (!result) {
        return {};
    }
    EXPECT_TRUE(decomp::mesh::check_topology(result->mesh).manifold());
    EXPECT_TRUE(decomp::repair::self_intersections(result->mesh, 1).empty());
    EXPECT_NEAR(decomp::mesh::volume_mm3(result->mesh), result->report.volume_after_mm3, 1e-9);
    EXPECT_GT(result->report.volume_after_mm3, 0);
    return *result;
}

TEST(Repair, ACleanBoxStaysAsItIs) {
    const TriMesh box = tests::box({0, 0, 0}, {1, 2, 3});
    const Repaired result = repaired(box);
    EXPECT_EQ(result.report.status, Status::Clean);
    EXPECT_TRUE(result.report.changes.empty());
    EXPECT_EQ(result.mesh.triangles, box.triangles);
}

TEST(Repair, ABoxInsideOutIsTurned) {
    const Repaired result = repaired(tests::flipped(tests::box({0, 0, 0}, {1, 2, 3})));
    EXPECT_EQ(result.report.status, Status::Clean);
    EXPECT_NEAR(result.report.volume_after_mm3, 6, 1e-12);
    EXPECT_NEAR(result.report.volume_before_mm3, -6, 1e-12);
}

TEST(Repair, TrianglesThatFaceTheWrongWayAreTurned) {
    TriMesh box = tests::box({0, 0, 0}, {1, 2, 3});
    std::swap(box.triangles[3][0], box.triangles[3][1]);
    std::swap(box.triangles[8][0], box.triangles[8][1]);
    const Repaired result = repaired(box);
    EXPECT_EQ(result.report.status, Status::Fixed);
    EXPECT_NEAR(result.report.volume_after_mm3, 6, 1e-12);
}

TEST(Repair, AMissingTriangleOfASphereIsFilled) {
    TriMesh sphere = tests::sphere(10, 24, 11);
    const double whole = decomp::mesh::volume_mm3(sphere);
    sphere.triangles.erase(sphere.triangles.begin() + 100);
    const Repaired result = repaired(sphere);
    EXPECT_EQ(result.report.status, Status::Fixed);
    EXPECT_NEAR(result.report.volume_after_mm3, whole, 1e-9 * whole);
}

TEST(Repair, ATriangleThatOccursTwiceIsRemovedOnce) {
    TriMesh box = tests::box({0, 0, 0}, {1, 2, 3});
    box.triangles.push_back(box.triangles[4]);
    EXPECT_NEAR(repaired(box).report.volume_after_mm3, 6, 1e-12);
}

TEST(Repair, AnInwardShellWithinABoxIsACavity) {
    const Repaired result = repaired(tests::joined(
        tests::box({0, 0, 0}, {10, 10, 10}), tests::flipped(tests::box({1, 1, 1}, {9, 9, 9}))));
    EXPECT_EQ(result.report.status, Status::Clean);
    EXPECT_EQ(result.report.voids, 1U);
    EXPECT_NEAR(result.report.volume_after_mm3, 1000 - 512, 1e-9);
}

TEST(Repair, AHollowBoxInsideOutKeepsItsCavity) {
    const Repaired result = repaired(tests::flipped(tests::joined(
        tests::box({0, 0, 0}, {10, 10, 10}), tests::flipped(tests::box({1, 1, 1}, {9, 9, 9})))));
    EXPECT_EQ(result.report.voids, 1U);
    EXPECT_NEAR(result.report.volume_after_mm3, 1000 - 512, 1e-9);
}

TEST(Repair, AnOutwardShellWithinSolidIsMaterialTwiceAndIsDropped) {
    const Repaired result = repaired(
        tests::joined(tests::box({0, 0, 0}, {10, 10, 10}), tests::box({1, 1, 1}, {9, 9, 9})));
    EXPECT_EQ(result.report.status, Status::Fixed);
    EXPECT_EQ(result.report.shells, 1U);
    EXPECT_NEAR(result.report.volume_after_mm3, 1000, 1e-9);
}

TEST(Repair, ASolidWithinACavityStays) {
    TriMesh nested = tests::joined(tests::box({0, 0, 0}, {10, 10, 10}),
                                   tests::flipped(tests::box({1, 1, 1}, {9, 9, 9})));
    nested = tests::joined(nested, tests::box({4, 4, 4}, {6, 6, 6}));
    const Repaired result = repaired(nested);
    EXPECT_EQ(result.report.shells, 3U);
    EXPECT_NEAR(result.report.volume_after_mm3, 1000 - 512 + 8, 1e-9);
}

TEST(Repair, WhereSensesMeanNothingShellsAlternate) {
    TriMesh nested =
        tests::joined(tests::box({0, 0, 0}, {10, 10, 10}), tests::box({1, 1, 1}, {9, 9, 9}));
    std::swap(nested.triangles[3][0], nested.triangles[3][1]);
    EXPECT_NEAR(repaired(nested).report.volume_after_mm3, 1000 - 512, 1e-9);
}

TEST(Repair, BoxesThatShareAnEdgeAreCutApartThere) {
    const Repaired result =
        repaired(tests::joined(tests::box({0, 0, 0}, {1, 1, 1}), tests::box({1, 1, 0}, {2, 2, 1})));
    EXPECT_NEAR(result.report.volume_after_mm3, 2, 1e-12);
    EXPECT_EQ(result.report.shells, 2U);
}

TEST(Repair, BoxesThatShareAWholeFaceBecomeOne) {
    const Repaired result = repaired(tests::joined(
        tests::box({0, 0, 0}, {1, 1, 1}), tests::flipped(tests::box({2, 1, 1}, {1, 0, 0}))));
    EXPECT_NEAR(result.report.volume_after_mm3, 2, 1e-12);
}

TEST(Repair, BoxesThatOverlapAreUnitedExactly) {
    const Repaired result =
        repaired(tests::joined(tests::box({0, 0, 0}, {2, 2, 2}), tests::box({1, 1, 1}, {3, 3, 3})));
    EXPECT_EQ(result.report.status, Status::United);
    EXPECT_EQ(result.report.shells, 1U);
    EXPECT_NEAR(result.report.volume_after_mm3, 15, 1e-12);
    EXPECT_EQ(result.report.hausdorff_mm, 0);
}

TEST(Repair, BoxesThatShareAPartOfAFaceBecomeOne) {
    const Repaired result = repaired(
        tests::joined(tests::box({0, 0, 0}, {2, 2, 2}), tests::box({2, 0.5, 0.5}, {3, 1.5, 1.5})));
    EXPECT_EQ(result.report.status, Status::United);
    EXPECT_NEAR(result.report.volume_after_mm3, 9, 1e-12);
}

TEST(Repair, AnInwardShellThatBreaksThroughIsSubtracted) {
    const Repaired result =
        repaired(tests::joined(tests::box({0, 0, 0}, {2, 2, 2}),
                               tests::flipped(tests::box({0.5, 0.5, 0.5}, {1.5, 1.5, 3}))));
    EXPECT_EQ(result.report.status, Status::United);
    EXPECT_NEAR(result.report.volume_after_mm3, 8 - 1.5, 1e-12);
}

TEST(Repair, AUnionKeepsTheCavityBesideIt) {
    TriMesh mesh =
        tests::joined(tests::box({0, 0, 0}, {4, 4, 4}), tests::box({3, 1, 1}, {6, 3, 3}));
    mesh = tests::joined(mesh, tests::flipped(tests::box({1, 1, 1}, {2, 2, 2})));
    const Repaired result = repaired(mesh);
    EXPECT_EQ(result.report.status, Status::United);
    EXPECT_EQ(result.report.voids, 1U);
    EXPECT_NEAR(result.report.volume_after_mm3, 64 + 8 - 1, 1e-12);
}

TEST(Repair, AChainThatTouchesItselfInAnEdgeIsCutApartThere) {
    // A chain of six cubes, face to face, whose last meets the second in one edge.
    TriMesh ring = tests::box({0, 0, 0}, {1, 1, 1});
    for (const auto& [x, y, z] : std::vector<std::array<double, 3>>{
             {1, 0, 0}, {2, 0, 0}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}}) {
        ring = tests::joined(ring, tests::box({x, y, z}, {x + 1, y + 1, z + 1}));
    }
    const Repaired result = repaired(ring);
    EXPECT_NEAR(result.report.volume_after_mm3, 6, 1e-12);
    EXPECT_EQ(result.report.shells, 1U);
}

TEST(Repair, ABoxWhoseEdgeLiesInAnothersFaceIsShrunkByAHairOrUnited) {
    TriMesh wedge;
    wedge.points = {{0, 0, 2}, {0, 4, 2}, {-1, 0, 3}, {-1, 4, 3}, {1, 0, 3}, {1, 4, 3}};
    wedge.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 4, 1}, {1, 4, 5},
                       {2, 3, 4}, {3, 5, 4}, {0, 2, 4}, {1, 5, 3}};
    if (decomp::mesh::volume_mm3(wedge) < 0) {
        wedge = tests::flipped(wedge);
    }
    const Repaired result = repaired(tests::joined(tests::box({-3, -3, 0}, {3, 7, 2}), wedge));
    EXPECT_EQ(result.report.status, Status::United);
    EXPECT_NEAR(result.report.volume_after_mm3, 120 + 4, 1e-3);
    EXPECT_LT(result.report.hausdorff_mm, 1e-3);
}

TEST(Repair, AFewCrossingsOfASmallFoldAreMendedLocally) {
    TriMesh sphere = tests::sphere(10, 40, 20);
    const double whole = decomp::mesh::volume_mm3(sphere);
    sphere.points[406] += 1.2 * (sphere.points[408] - sphere.points[406]);
    const Repaired result = repaired(sphere);
    EXPECT_EQ(result.report.status, Status::Fixed);
    EXPECT_NEAR(result.report.volume_after_mm3, whole, 1e-3 * whole);
    EXPECT_LT(result.report.hausdorff_mm, 0.2);
}

TEST(Repair, ATubeThatRunsIntoItselfIsCutAndItsOutsideKept) {
    // A tube along a spiral of 1.1 turns, closed by two fans: its end overlaps its beginning.
    constexpr std::uint32_t kSections = 45;
    constexpr std::uint32_t kRound = 12;
    TriMesh tube;
    for (std::uint32_t i = 0; i < kSections; ++i) {
        const double u = 2.2 * std::numbers::pi * i / (kSections - 1);
        for (std::uint32_t j = 0; j < kRound; ++j) {
            const double v = 2 * std::numbers::pi * (j + 0.3) / kRound;
            const double r = 10 + 0.35 * u + 3 * std::cos(v);
            tube.points.emplace_back(r * std::cos(u), r * std::sin(u), 3 * std::sin(v) + 0.05 * u);
        }
    }
    for (std::uint32_t i = 0; i + 1 < kSections; ++i) {
        for (std::uint32_t j = 0; j < kRound; ++j) {
            const std::uint32_t a = i * kRound + j;
            const std::uint32_t b = i * kRound + (j + 1) % kRound;
            tube.triangles.push_back({a, a + kRound, b + kRound});
            tube.triangles.push_back({a, b + kRound, b});
        }
    }
    const std::uint32_t last = (kSections - 1) * kRound;
    for (std::uint32_t j = 1; j + 1 < kRound; ++j) {
        tube.triangles.push_back({0, j, j + 1});
        tube.triangles.push_back({last, last + j + 1, last + j});
    }
    const double twice = decomp::mesh::volume_mm3(tube);
    const Repaired result = repaired(tube);
    EXPECT_EQ(result.report.status, Status::United);
    EXPECT_EQ(result.report.hausdorff_mm, 0);
    EXPECT_LT(result.report.volume_after_mm3, twice);
    EXPECT_GT(result.report.volume_after_mm3, 0.9 * twice);
}

TEST(Repair, ALooseSheetBesideABodyIsRemoved) {
    TriMesh mesh = tests::box({0, 0, 0}, {10, 10, 10});
    mesh.points.insert(mesh.points.end(), {{20, 0, 0}, {21, 0, 0}, {20, 1, 0}});
    mesh.triangles.push_back({8, 9, 10});
    const Repaired result = repaired(mesh);
    EXPECT_EQ(result.report.status, Status::Fixed);
    EXPECT_NEAR(result.report.volume_after_mm3, 1000, 1e-9);
}

TEST(Repair, AMissingFaceOfABoxIsFilled) {
    TriMesh box = tests::box({0, 0, 0}, {1, 2, 3});
    box.triangles.resize(10);
    EXPECT_NEAR(repaired(box).report.volume_after_mm3, 6, 1e-12);
}

TEST(Repair, ACornerThatMissesItsNeighboursByLittleIsMovedOntoThem) {
    TriMesh box = tests::box({0, 0, 0}, {1, 1, 1});
    box.points.push_back({0, 0, 1e-4});
    box.triangles[0][0] = 8;
    const Repaired result = repaired(box);
    EXPECT_EQ(result.report.status, Status::Fixed);
    EXPECT_NEAR(result.report.volume_after_mm3, 1, 1e-3);
    EXPECT_EQ(result.mesh.triangles.size(), 12U);
}

TEST(Repair, AnOpenTubeIsNotASolid) {
    TriMesh tube = tests::torus(10, 3, 24, 12);
    tube.triangles.resize(tube.triangles.size() / 2);
    const auto result = repair(tube, {}, decomp::Run{});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, "repair.not_a_solid");
}

TEST(Repair, WhereWrappingIsForbiddenItIsAskedFor) {
    TriMesh tube = tests::torus(10, 3, 24, 12);
    tube.triangles.resize(tube.triangles.size() / 2);
    const auto result = repair(tube, {.allow_wrap = false}, decomp::Run{});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, "repair.wrap_needed");
}

TEST(Repair, NothingIsEmpty) {
    EXPECT_EQ(repair({}, {}, decomp::Run{}).error().code, "repair.empty");
}

}  // namespace
