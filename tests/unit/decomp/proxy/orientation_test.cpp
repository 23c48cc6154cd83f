// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/proxy/orientation.h"

#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using decomp::proxy::misalignment;
using decomp::proxy::orientation_candidates;

tests::TriMesh turned_box(double degrees) {
    const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
    return decomp::mesh::transformed(
        tests::box({-15, -10, -5}, {15, 10, 5}),
        Eigen::Affine3d(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis)));
}

TEST(Orientation, ABoxAlongTheAxesHasMisalignmentOne) {
    EXPECT_NEAR(misalignment(turned_box(0), Eigen::Matrix3d::Identity()), 1, 1e-12);
    EXPECT_GT(misalignment(turned_box(30), Eigen::Matrix3d::Identity()), 1.2);
}

TEST(Orientation, TheFirstCandidateIsTheIdentityAndAllAreRotations) {
    const auto candidates = orientation_candidates(turned_box(30));
    ASSERT_GE(candidates.size(), 2U);
    EXPECT_LE(candidates.size(), 6U);
    EXPECT_TRUE(candidates[0].isIdentity());
    for (const auto& rotation : candidates) {
        EXPECT_NEAR(rotation.determinant(), 1, 1e-9);
        EXPECT_TRUE((rotation * rotation.transpose()).isIdentity(1e-9));
    }
}

TEST(Orientation, TheSecondCandidateStraightensATurnedBoxAndATiltOfFiveDegrees) {
    for (const double degrees : {30.0, 5.0}) {
        const auto box = turned_box(degrees);
        const auto candidates = orientation_candidates(box);
        ASSERT_GE(candidates.size(), 2U);
        EXPECT_LT(misalignment(box, candidates[1]), 1.01) << degrees;
    }
}

TEST(Orientation, AStraightBoxGetsNoSecondOptimumAtQuarterTurns) {
    for (const auto& rotation : orientation_candidates(turned_box(0))) {
        const bool straight = misalignment(turned_box(0), rotation) < 1.01;
        EXPECT_EQ(straight, rotation.isIdentity());
    }
}

}  // namespace
