// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/intersect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using decomp::solid::curve_along;
using decomp::solid::CylinderSurface;
using decomp::solid::EllipseCurve;
using decomp::solid::PlaneSurface;
using Eigen::Vector3d;

/// The plane through two points of the cylinder at one height, 22 degrees apart, that leans so much
/// from its axis.
PlaneSurface leaning(double lean, const Vector3d& on_it) {
    const Vector3d normal(std::cos(lean), 0, std::sin(lean));
    return {normal, normal.dot(on_it)};
}

TEST(Intersection, AnArcFollowsItsChordAndNeverGoesTheFarWayRound) {
    const CylinderSurface cylinder{Vector3d::Zero(), Vector3d::UnitZ(), 18};
    const double half = 11 * std::numbers::pi / 180;
    const Vector3d from(18 * std::cos(half), -18 * std::sin(half), 0);
    const Vector3d to(18 * std::cos(half), 18 * std::sin(half), 0);
    for (const double steep : {0.5, 1.0, 1.5}) {
        const auto arc = curve_along(cylinder, leaning(steep, from), {from, to}, false);
        ASSERT_TRUE(arc) << steep;
        EXPECT_LE(arc->off_mm, 1e-9);
        EXPECT_LE((point_at(arc->curve, (arc->t0 + arc->t1) / 2) - (from + to) / 2).norm(), 1);
    }
    for (const double flat : {0.002, 0.01, 0.05}) {
        EXPECT_FALSE(curve_along(cylinder, leaning(flat, from), {from, to}, false)) << flat;
    }
}

}  // namespace
