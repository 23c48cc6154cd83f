// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/decompose.h"

#include "cam/orient/choose_build.h"
#include "decomp/base/rng.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/pipeline/nudge.h"
#include "decomp/pipeline/proxy.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using decomp::Result;
using decomp::mesh::TriMesh;
using decomp::pipeline::decompose;
using decomp::pipeline::DecomposeOptions;
using decomp::pipeline::Decomposition;

cam::profile::FdmSetup printer(double x, double y, double z) {
    cam::profile::FdmSetup setup;
    setup.machine.chamber.min_mm = {-x / 2, -y / 2, 0};
    setup.machine.chamber.max_mm = {x / 2, y / 2, z};
    setup.machine.process.brim_width_mm = 3;
    return setup;
}

/// Decomposes and asserts what must hold for every result.
Decomposition sound(const TriMesh& volume, const cam::profile::FdmSetup& setup, int jobs = 2) {
    decomp::Run run;
    run.jobs = jobs;
    const Result<Decomposition> result = decompose(volume, {}, cam::orient::fdm_judge(setup), run);
    EXPECT_TRUE(result.has_value()) << result.error().text();
    if (!result) {
        return {};
    }
    double sum = 0;
    const Eigen::Vector3d usable = cam::orient::usable_mm(setup.machine);
    EXPECT_EQ(result->poses.size(), result->assembly.parts.size());
    for (std::size_t i = 0; i < result->assembly.parts.size(); ++i) {
        const auto& part = result->assembly.parts[i];
        sum += decomp::mesh::volume_mm3(part.mesh);
        EXPECT_TRUE(decomp::mesh::check_topology(part.mesh).manifold()) << part.id;
        EXPECT_TRUE(result->verdicts[i].ok()) << part.id;
        const Eigen::Vector3d size =
            decomp::mesh::bounds(cam::orient::placed(part, result->poses[i])).sizes();
        EXPECT_TRUE((size.array() <= usable.array() + 1e-9).all())
            << part.id << ": " << size.transpose();
    }
    const double volume_mm3 = decomp::mesh::volume_mm3(volume);
    EXPECT_NEAR(sum, volume_mm3, 1e-9 * volume_mm3);
    return *result;
}

TEST(Decompose, WhatFitsStaysInOnePiece) {
    const auto result = sound(tests::sphere(20, 32, 17), printer(60, 60, 60));
    EXPECT_EQ(result.assembly.parts.size(), 1U);
    EXPECT_EQ(result.cuts, 0);
    EXPECT_EQ(result.tier, "T4");
}

TEST(Decompose, ATallBoxIsHalved) {
    const auto result = sound(tests::box({0, 0, 0}, {40, 40, 100}), printer(60, 60, 60));
    ASSERT_EQ(result.assembly.parts.size(), 2U);
    const double first = decomp::mesh::volume_mm3(result.assembly.parts[0].mesh);
    EXPECT_NEAR(first / 160000, 0.5, 0.01);
}

TEST(Decompose, ALongBoxIsCutIntoAsFewSlabsAsFit) {
    // 260 / 59.8 high, or laid down 260 / 54 wide: five are needed either way.
    EXPECT_EQ(
        sound(tests::box({0, 0, 0}, {40, 40, 260}), printer(60, 60, 60)).assembly.parts.size(), 5U);
}

TEST(Decompose, ARandomlyTurnedDumbbellIsCutWithinTwoPercentOfItsNeck) {
    decomp::Rng rng(11);
    for (int trial = 0; trial < 2; ++trial) {
        const double neck_z = rng.uniform(-12, 12);
        Eigen::Affine3d map = Eigen::Affine3d::Identity();
        map.linear() = Eigen::Quaterniond(rng.uniform(-1, 1), rng.uniform(-1, 1),
                                          rng.uniform(-1, 1), rng.uniform(-1, 1))
                           .normalized()
                           .toRotationMatrix();
        const auto shape = decomp::mesh::transformed(tests::dumbbell(30, 8, 100, neck_z, 32), map);
        const auto result = sound(shape, printer(135, 135, 130));
        ASSERT_EQ(result.assembly.parts.size(), 2U);
        const auto& plane = result.assembly.planes.at(
            static_cast<std::size_t>(result.assembly.interfaces[0].plane));
        const Eigen::Vector3d neck = map.linear() * Eigen::Vector3d(0, 0, neck_z);
        EXPECT_LT(std::abs(plane.normal.dot(neck) - plane.offset_mm) / plane.normal.norm(),
                  0.02 * 200);
        EXPECT_GT(std::abs(plane.normal.normalized().dot(map.linear() * Eigen::Vector3d::UnitZ())),
                  0.99);
    }
}

TEST(Decompose, ATorusIsAnExactPartition) {
    const auto result = sound(tests::torus(50, 12, 64, 32), printer(90, 90, 60));
    EXPECT_GE(result.assembly.parts.size(), 2U);
    EXPECT_LE(result.assembly.parts.size(), 4U);
}

TEST(Decompose, AHollowBallIsOpenedAndItsCavityKept) {
    const auto hollow =
        tests::joined(tests::sphere(40, 40, 21), tests::flipped(tests::sphere(30, 40, 21)));
    const auto result = sound(hollow, printer(95, 95, 60));
    EXPECT_EQ(result.assembly.parts.size(), 2U);
}

TEST(Decompose, TwoBodiesAreTwoPartsAndOnlyTheLargeOneIsCut) {
    const auto bodies =
        tests::joined(tests::box({0, 0, 0}, {20, 20, 20}), tests::box({40, 0, 0}, {70, 30, 100}));
    const auto result = sound(bodies, printer(60, 60, 60));
    EXPECT_EQ(result.assembly.parts.size(), 3U);
    EXPECT_EQ(result.cuts, 1);
}

TEST(Decompose, AThinPlateIsCutAcrossNotThrough) {
    const auto result = sound(tests::box({0, 0, 0}, {150, 90, 4}), printer(100, 100, 60));
    ASSERT_EQ(result.assembly.parts.size(), 2U);
    for (const auto& part : result.assembly.parts) {
        EXPECT_NEAR(decomp::mesh::bounds(part.mesh).sizes().z(), 4, 1e-9);
    }
}

TEST(Decompose, TheNumberOfJobsDoesNotChangeTheResult) {
    const auto shape = tests::torus(50, 12, 48, 24);
    const auto one = sound(shape, printer(90, 90, 60), 1);
    const auto two = sound(shape, printer(90, 90, 60), 2);
    ASSERT_EQ(one.assembly.parts.size(), two.assembly.parts.size());
    for (std::size_t i = 0; i < one.assembly.parts.size(); ++i) {
        EXPECT_EQ(one.assembly.parts[i].mesh.points, two.assembly.parts[i].mesh.points);
        EXPECT_EQ(one.assembly.parts[i].mesh.triangles, two.assembly.parts[i].mesh.triangles);
        EXPECT_EQ(one.poses[i].row_major(), two.poses[i].row_major());
    }
}

TEST(Decompose, TooManyPartsIsAnErrorThatSaysWhatToTry) {
    decomp::Run run;
    DecomposeOptions options;
    options.max_parts = 3;
    const auto result = decompose(tests::box({0, 0, 0}, {40, 40, 400}), options,
                                  cam::orient::fdm_judge(printer(60, 60, 60)), run);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, "decompose.too_many_parts");
    EXPECT_FALSE(result.error().hint.empty());
}

TEST(Decompose, AJudgeThatIsNeverContentEndsInAnError) {
    decomp::Run run;
    DecomposeOptions options;
    options.max_parts = 4;
    const decomp::part::Judge never = [](const decomp::part::Part&, decomp::part::Fidelity) {
        decomp::part::Verdict verdict;
        verdict.violations = {{"anything", 2}};
        return verdict;
    };
    const auto result = decompose(tests::box({0, 0, 0}, {10, 10, 10}), options, never, run);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, "decompose.too_many_parts");
}

TEST(Decompose, ACancelledRunSaysSo) {
    decomp::Run run;
    std::stop_source source;
    run.stop = source.get_token();
    source.request_stop();
    const auto result = decompose(tests::box({0, 0, 0}, {40, 40, 400}), {},
                                  cam::orient::fdm_judge(printer(60, 60, 60)), run);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, "run.cancelled");
}

TEST(Nudge, APlaneThroughVerticesMovesHalfAStepAwayAndNoFurtherThanNeeded) {
    const auto box = tests::box({0, 0, 0}, {1, 1, 1});
    const auto plane = decomp::pipeline::nudged({{0, 0, 1}, 1}, box, 0.01);
    EXPECT_NEAR(plane.offset_mm, 1.01, 1e-12);
    EXPECT_EQ(decomp::pipeline::nudged({{0, 0, 1}, 0.5}, box, 0.01).offset_mm, 0.5);
}

TEST(Proxy, ASimplifiedBallKeepsItsVolumeAndItsTopology) {
    decomp::part::Part ball;
    ball.mesh = tests::sphere(20, 160, 99);
    ball.sources.resize(ball.mesh.triangles.size());
    const auto proxy = decomp::pipeline::simplified(ball, 2000);
    EXPECT_LT(proxy.mesh.triangles.size(), 2600U);
    EXPECT_EQ(proxy.sources.size(), proxy.mesh.triangles.size());
    EXPECT_TRUE(decomp::mesh::check_topology(proxy.mesh).manifold());
    EXPECT_NEAR(decomp::mesh::volume_mm3(proxy.mesh) / decomp::mesh::volume_mm3(ball.mesh), 1,
                1e-2);
}

}  // namespace
