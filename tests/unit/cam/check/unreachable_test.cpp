// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/unreachable.h"

#include "cam/check/mill4.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/intersect.h"
#include "tests/support/part_shapes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using cam::check::drop_unreachable;
using cam::check::Dropped;
using tests::TriMesh;

/// A block with a bottle-shaped hole from above: neck radius 3, belly radius 8.
TriMesh flask() {
    return tests::revolved(5, {{8, 5}, {8, 20}, {3, 22}, {3, 30}, {15, 30}, {15, 0}}, 0, 64);
}

Dropped without_unseen(const TriMesh& mesh, const Eigen::Vector3d& axis) {
    cam::check::Mill4Options options;
    options.axis = axis;
    options.find_indices = false;
    const auto check = cam::check::check_mill4(tests::whole(mesh), options, {}, {}).value();
    std::vector<char> wanted = check.facets.seen;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (check.facets.end[i] != 0 && check.facets.hidden_end[i] == 0) {
            wanted[i] = 1;
        }
    }
    return drop_unreachable(mesh, wanted, {}).value();
}

void expect_sound(const TriMesh& mesh) {
    EXPECT_TRUE(decomp::mesh::check_topology(mesh).manifold());
    EXPECT_TRUE(decomp::repair::self_intersections(mesh, 10).empty());
    EXPECT_GT(decomp::mesh::volume_mm3(mesh), 0);
}

TEST(DropUnreachable, WhatIsSeenStaysAsItIs) {
    const auto mesh = tests::sphere(10, 24, 13);
    const auto out =
        drop_unreachable(mesh, std::vector<char>(mesh.triangles.size(), 1), {}).value();
    EXPECT_EQ(out.facets, 0U);
    EXPECT_EQ(out.patches, 0U);
    EXPECT_EQ(out.mesh.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(out.volume_after_mm3, out.volume_before_mm3);
}

TEST(DropUnreachable, APatchOfASphereBecomesItsLid) {
    const auto mesh = tests::sphere(10, 48, 25);
    std::vector<char> wanted(mesh.triangles.size(), 1);
    const auto facets = decomp::mesh::measure_facets(mesh);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        wanted[i] = facets.centre[i].z() < 6 ? 1 : 0;
    }
    const auto out = drop_unreachable(mesh, wanted, {}).value();
    EXPECT_EQ(out.patches, 1U);
    EXPECT_EQ(out.patches_left, 0U);
    expect_sound(out.mesh);
    EXPECT_LT(out.volume_after_mm3, out.volume_before_mm3);
    EXPECT_GT(out.volume_after_mm3, 0.85 * out.volume_before_mm3);
}

TEST(DropUnreachable, TheBellyOfAFlaskIsFilledAtItsNeck) {
    // About an axis across it the flask's belly is dark, its neck is not.
    const auto mesh = flask();
    const auto out = without_unseen(mesh, Eigen::Vector3d::UnitX());
    expect_sound(out.mesh);
    EXPECT_GE(out.patches, 1U);
    EXPECT_GT(out.volume_after_mm3, out.volume_before_mm3);
    EXPECT_LT(decomp::mesh::volume_mm3(out.mesh), std::numbers::pi * 15 * 15 * 30);
}

TEST(DropUnreachable, ACavityIsFilled) {
    const auto mesh = tests::joined(tests::box({0, 0, 0}, {20, 20, 20}),
                                    tests::flipped(tests::box({5, 5, 5}, {10, 10, 10})));
    const auto out = without_unseen(mesh, Eigen::Vector3d::UnitX());
    EXPECT_EQ(out.cavities, 1U);
    EXPECT_NEAR(out.volume_after_mm3, 8000, 1e-6);
    EXPECT_NEAR(out.volume_before_mm3, 8000 - 125, 1e-6);
    expect_sound(out.mesh);
}

TEST(DropUnreachable, ABandIsLeftBecauseThePartWouldFallApart) {
    const auto mesh = tests::cylinder_x(10, 40, 48);
    std::vector<char> wanted(mesh.triangles.size(), 0);
    const auto facets = decomp::mesh::measure_facets(mesh);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        wanted[i] = std::abs(facets.unit[i].x()) > 0.5 ? 1 : 0;  // the ends only
    }
    const auto out = drop_unreachable(mesh, wanted, {}).value();
    EXPECT_EQ(out.facets, 0U);
    EXPECT_EQ(out.patches_left, 1U);
    EXPECT_GT(out.area_left_mm2, 0);
    EXPECT_EQ(out.volume_after_mm3, out.volume_before_mm3);
}

TEST(DropUnreachable, ASpeckInsideAPatchGoesWithIt) {
    const auto mesh = tests::sphere(10, 48, 25);
    const auto facets = decomp::mesh::measure_facets(mesh);
    std::vector<char> wanted(mesh.triangles.size(), 1);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        wanted[i] = facets.centre[i].z() < 6 || facets.centre[i].z() > 9.97 ? 1 : 0;
    }
    const auto out = drop_unreachable(mesh, wanted, {}).value();
    EXPECT_EQ(out.patches, 1U);
    EXPECT_EQ(out.patches_left, 0U);
    expect_sound(out.mesh);
}

}  // namespace
