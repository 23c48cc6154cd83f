// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/decompose.h"

#include "cam/orient/choose_build.h"
#include "decomp/base/rng.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/property/decomp/pipeline/sound.h"
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

using tests::printer;
using tests::sound;

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
    const auto result = sound(tests::torus(50, 12, 32, 16), printer(90, 90, 60));
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
    const auto shape = tests::torus(50, 12, 24, 12);
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

}  // namespace
