// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sheets/fit.h"

#include "decomp/base/rng.h"

#include <gtest/gtest.h>

namespace {

using decomp::sheets::fitted_offset;
using decomp::sheets::fitted_plane;
using decomp::sheets::residual;
using decomp::sheets::Sample;

std::vector<Sample> on_plane(const Eigen::Vector3d& normal, double offset, int count) {
    decomp::Rng rng(3);
    std::vector<Sample> out;
    for (int i = 0; i < count; ++i) {
        Eigen::Vector3d p(rng.uniform(-10, 10), rng.uniform(-10, 10), rng.uniform(-10, 10));
        p -= (normal.dot(p) - offset) * normal;
        out.push_back({p, rng.uniform(0.5, 2)});
    }
    return out;
}

TEST(Fit, PointsOfAPlaneGiveThatPlane) {
    const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 3).normalized();
    const std::vector<Sample> samples = on_plane(normal, 4, 50);
    const auto plane = fitted_plane(samples, Eigen::Vector3d::UnitZ());
    EXPECT_TRUE(plane.normal.isApprox(normal, 1e-9));
    EXPECT_NEAR(plane.offset_mm, 4, 1e-9);
    EXPECT_LT(residual(samples, plane).max_mm, 1e-9);
    EXPECT_TRUE(fitted_plane(samples, -Eigen::Vector3d::UnitZ()).normal.isApprox(-normal, 1e-9));
}

TEST(Fit, AFewStrayPointsHardlyTurnThePlane) {
    std::vector<Sample> samples = on_plane(Eigen::Vector3d::UnitZ(), 0, 200);
    for (Sample& sample : samples) {
        sample.point.z() += 0.01 * std::sin(7 * sample.point.x());
    }
    for (int i = 0; i < 12; ++i) {
        samples.push_back({{9, 9, 6.0 + i / 4.0}, 1});
    }
    const auto plane = fitted_plane(samples, Eigen::Vector3d::UnitZ());
    EXPECT_GT(plane.normal.z(), 0.999);
    EXPECT_LT(std::abs(plane.offset_mm), 0.1);
}

TEST(Fit, TheOffsetAloneIsFittedForAGivenNormal) {
    const auto plane =
        fitted_offset({{{0, 0, 1}, 1}, {{5, 0, 3}, 1}, {{0, 5, 2}, 1}}, Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(plane.offset_mm, 2, 1e-9);
    const auto r = residual({{{0, 0, 3}, 1}, {{0, 0, -1}, 3}}, {Eigen::Vector3d::UnitZ(), 0});
    EXPECT_DOUBLE_EQ(r.rms_mm, std::sqrt((9.0 + 3) / 4));
    EXPECT_DOUBLE_EQ(r.max_mm, 3);
}

}  // namespace
