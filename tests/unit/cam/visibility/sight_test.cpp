// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/visibility/sight.h"

#include "decomp/base/rng.h"
#include "decomp/mesh/measure.h"
#include "tests/support/oracle_sight.h"
#include "tests/support/part_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using cam::visibility::Facing;
using cam::visibility::Sight;
using decomp::mesh::measure_facets;
using tests::TriMesh;

std::vector<Eigen::Vector3d> ring(int count) {
    std::vector<Eigen::Vector3d> out;
    for (int j = 0; j < count; ++j) {
        const double angle = 2 * std::numbers::pi * j / count;
        out.emplace_back(0, std::sin(angle), std::cos(angle));
    }
    return out;
}

Eigen::Vector3d random_direction(decomp::Rng& rng) {
    const double z = rng.uniform(-1, 1);
    const double angle = rng.uniform(0, 2 * std::numbers::pi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Facets on which Embree and brute force disagree, as a share of all questions.
double disagreement(const TriMesh& mesh, std::uint64_t seed) {
    const auto facets = measure_facets(mesh);
    const auto sight = Sight::of(mesh, facets).value();
    const double lift_mm = 1e-5 * decomp::mesh::diagonal_mm(mesh);
    decomp::Rng rng(seed);
    int differ = 0;
    constexpr int kQuestions = 3000;
    for (int i = 0; i < kQuestions; ++i) {
        const std::size_t facet = rng.below(mesh.triangles.size());
        const Eigen::Vector3d direction = random_direction(rng);
        differ += sight.sees(facet, direction, Facing::Front) !=
                          tests::oracle_sees(mesh, facet, direction, lift_mm)
                      ? 1
                      : 0;
    }
    return differ / double{kQuestions};
}

TEST(Sight, AgreesWithBruteForceInDoublePrecision) {
    EXPECT_LE(disagreement(tests::torus(20, 8, 40, 20), 1), 0.0007);
    EXPECT_LE(disagreement(tests::dumbbell(20, 4, 50, 7, 24), 2), 0.0007);
    const auto two =
        tests::joined(tests::box({0, 0, 0}, {30, 20, 5}), tests::box({5, 5, 9}, {25, 15, 14}));
    EXPECT_LE(disagreement(two, 3), 0.0007);
    // A plate with a roof above it, far from the origin: float32 must not feel the distance.
    auto far = two;
    for (auto& point : far.points) {
        point += Eigen::Vector3d(100000, -50000, 70000);
    }
    EXPECT_LE(disagreement(far, 4), 0.0007);
}

TEST(Sight, AConvexShapeSeesWhateverItFaces) {
    const TriMesh mesh = tests::sphere(30, 48, 25);
    const auto facets = measure_facets(mesh);
    const auto sight = Sight::of(mesh, facets).value();
    const auto directions = ring(40);
    const auto masks = sight.seen_masks(directions, Facing::Front, {});
    for (std::size_t i = 0; i < masks.size(); ++i) {
        for (std::size_t j = 0; j < directions.size(); ++j) {
            EXPECT_EQ((masks[i] >> j & 1U) != 0, facets.unit[i].dot(directions[j]) > 0);
        }
    }
}

TEST(Sight, WhatIsSeenFromAnyIsWhatHasAMask) {
    const TriMesh mesh = tests::torus(20, 8, 36, 18);
    const auto facets = measure_facets(mesh);
    const auto sight = Sight::of(mesh, facets).value();
    const auto directions = ring(40);
    const auto masks = sight.seen_masks(directions, Facing::Front, {});
    const auto seen = sight.seen_from_any(directions, Facing::Front, {});
    for (std::size_t i = 0; i < masks.size(); ++i) {
        EXPECT_EQ(seen[i] != 0, masks[i] != 0);
    }
}

TEST(Sight, AQuickTreeGivesTheAnswersOfAFineOne) {
    for (const TriMesh& mesh : {tests::torus(20, 8, 90, 45), tests::dumbbell(20, 4, 50, 7, 48),
                                tests::hook(10, 40, 15)}) {
        const auto facets = measure_facets(mesh);
        const auto fine = Sight::of(mesh, facets).value();
        const auto quick = Sight::of(mesh, facets, cam::visibility::Tree::Quick).value();
        for (const Facing facing : {Facing::Front, Facing::Wall}) {
            EXPECT_EQ(quick.seen_masks(ring(40), facing, {}),
                      fine.seen_masks(ring(40), facing, {}));
        }
    }
}

TEST(Sight, ARoofHidesTheFloorBelowIt) {
    const auto mesh =
        tests::joined(tests::box({0, 0, 0}, {30, 20, 5}), tests::box({-5, -5, 9}, {35, 25, 14}));
    const auto facets = measure_facets(mesh);
    const auto sight = Sight::of(mesh, facets).value();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const bool floor = i < 12 && facets.unit[i].z() > 0.5;
        const bool roof = i >= 12 && facets.unit[i].z() > 0.5;
        EXPECT_EQ(sight.sees(i, Eigen::Vector3d::UnitZ(), Facing::Front), roof) << i;
        if (floor) {
            EXPECT_FALSE(sight.sees(i, Eigen::Vector3d::UnitZ(), Facing::Wall));
        }
    }
}

TEST(Sight, AWallCountsOnlyWhereWallsDo) {
    const auto mesh = tests::box({0, 0, 0}, {10, 10, 10});
    const auto facets = measure_facets(mesh);
    const auto sight = Sight::of(mesh, facets).value();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double up = facets.unit[i].z();
        EXPECT_EQ(sight.sees(i, Eigen::Vector3d::UnitZ(), Facing::Front), up > 0.5);
        EXPECT_EQ(sight.sees(i, Eigen::Vector3d::UnitZ(), Facing::Wall), up > -0.5);
    }
}

TEST(Sight, ASecondOpinionAgreesOnASmoothShape) {
    const TriMesh mesh = tests::torus(20, 8, 60, 30);
    const auto facets = measure_facets(mesh);
    const auto sight = Sight::of(mesh, facets).value();
    int differ = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const Eigen::Vector3d& direction : ring(8)) {
            const bool first = sight.sees(i, direction, Facing::Front);
            differ +=
                first != sight.sees(i, direction, Facing::Front, {.lift = 1e-6, .skip_own = true})
                    ? 1
                    : 0;
        }
    }
    EXPECT_LE(differ, 20);  // of 28 800
}

TEST(Sight, OneThreadAndTwoSeeTheSame) {
    const TriMesh mesh = tests::torus(20, 8, 60, 30);
    const auto facets = measure_facets(mesh);
    const auto sight = Sight::of(mesh, facets).value();
    decomp::Run two;
    two.jobs = 2;
    EXPECT_EQ(sight.seen_masks(ring(40), Facing::Front, {}),
              sight.seen_masks(ring(40), Facing::Front, two));
}

}  // namespace
