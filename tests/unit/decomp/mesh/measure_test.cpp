// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/measure.h"

#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

TEST(MeshMeasure, ABoxHasItsVolumeAndArea) {
    const auto box = tests::box({1, 1, 1}, {2, 3, 4});
    EXPECT_DOUBLE_EQ(decomp::mesh::volume_mm3(box), 6);
    EXPECT_DOUBLE_EQ(decomp::mesh::area_mm2(box), 22);
}

TEST(MeshMeasure, AnInsideOutBoxHasNegativeVolume) {
    EXPECT_DOUBLE_EQ(decomp::mesh::volume_mm3(tests::flipped(tests::box({0, 0, 0}, {1, 1, 1}))),
                     -1);
}

TEST(MeshMeasure, AFineSphereApproachesTheClosedForm) {
    const double exact = 4.0 / 3.0 * std::numbers::pi * 1000;
    EXPECT_NEAR(decomp::mesh::volume_mm3(tests::sphere(10, 200, 99)) / exact, 1, 1e-3);
}

TEST(MeshMeasure, MirroringKeepsTheVolumePositive) {
    Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
    mirror.linear()(0, 0) = -1;
    const auto box = decomp::mesh::transformed(tests::box({0, 0, 0}, {1, 2, 3}), mirror);
    EXPECT_DOUBLE_EQ(decomp::mesh::volume_mm3(box), 6);
}

}  // namespace
