// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/flats.h"

#include "decomp/mesh/measure.h"
#include "decomp/mesh/moments.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>

namespace {

using decomp::mesh::Flat;
using decomp::mesh::large_flats;

TEST(MeshFlats, ABoxHasSixOnItsHullLargestFirst) {
    const auto flats = large_flats(tests::box({0, 0, 0}, {1, 2, 3}));
    ASSERT_EQ(flats.size(), 6U);
    for (const Flat& flat : flats) {
        EXPECT_TRUE(flat.on_hull);
    }
    EXPECT_DOUBLE_EQ(flats[0].area_mm2, 6);
    EXPECT_DOUBLE_EQ(flats[5].area_mm2, 2);
}

TEST(MeshFlats, ATurnedTruncatedBallHasOne) {
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.linear() = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.33).normalized().toRotationMatrix();
    auto ball = tests::sphere(20, 64, 41);
    for (auto& point : ball.points) {
        point.z() = std::max(point.z(), -12.0);
    }
    const auto flats = large_flats(decomp::mesh::transformed(ball, map));
    ASSERT_EQ(flats.size(), 1U);
    EXPECT_LT((flats[0].normal + map.linear() * Eigen::Vector3d::UnitZ()).norm(), 1e-6);
    EXPECT_NEAR(flats[0].offset_mm, 12, 1e-4);
}

TEST(MeshFlats, AStepInsideTheHullIsFoundToo) {
    const auto flats =
        large_flats(tests::revolved(60, {{10, 60}, {10, 20}, {40, 20}, {40, 0}}, 0, 8));
    const auto inner =
        std::count_if(flats.begin(), flats.end(), [](const Flat& flat) { return !flat.on_hull; });
    EXPECT_EQ(inner, 1);
}

TEST(MeshMoments, ABoxHasItsClosedForms) {
    const auto moments = decomp::mesh::moments(tests::box({0, 0, 0}, {2, 6, 4}));
    EXPECT_NEAR(moments.volume_mm3, 48, 1e-12);
    EXPECT_LT((moments.centre - Eigen::Vector3d(1, 3, 2)).norm(), 1e-12);
    EXPECT_NEAR(moments.covariance(1, 1), 36.0 / 12, 1e-12);
    EXPECT_NEAR(moments.axes.col(0).y(), 1, 1e-12);
}

}  // namespace
