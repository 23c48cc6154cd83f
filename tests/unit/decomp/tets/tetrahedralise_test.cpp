// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/tetrahedralise.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/tets/boundary.h"
#include "decomp/tets/measure.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace decomp;

std::vector<mesh::Triangle> sorted_triangles(const std::vector<mesh::Triangle>& triangles) {
    std::vector<mesh::Triangle> out;
    for (mesh::Triangle t : triangles) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        out.push_back(t);
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// Positive tets that fill the surface, whose triangles and points they keep.
void expect_filled(const mesh::TriMesh& surface, const tets::TetMesh& tets) {
    double volume = 0;
    for (const tets::Tet& tet : tets.tets) {
        const double six = tets::six_volumes(tets.points, tet);
        EXPECT_GT(six, 0);
        volume += six / 6;
    }
    const double wanted = mesh::volume_mm3(surface);
    EXPECT_NEAR(volume, wanted, 1e-9 * wanted);
    ASSERT_GE(tets.points.size(), surface.points.size());
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
        ASSERT_EQ(tets.points[i], surface.points[i]);
    }
    std::vector<mesh::Triangle> boundary;
    for (const auto& facet : tets::boundary_of(tets.tets)) {
        boundary.push_back(facet.corners);
    }
    EXPECT_EQ(sorted_triangles(boundary), sorted_triangles(surface.triangles));
}

TEST(Tetrahedralise, KeepsTheTrianglesOfASphereAndATorus) {
    for (const auto& surface : {tests::sphere(10, 24, 13), tests::torus(10, 4, 36, 16)}) {
        decomp::Run run;
        const auto tets = tets::tetrahedralise(surface, run);
        ASSERT_TRUE(tets.has_value()) << tets.error().text();
        expect_filled(surface, *tets);
    }
}

TEST(Tetrahedralise, ACavityIsRefusedByGmshAndLeftEmptyByMesh3) {
    const auto hollow =
        tests::joined(tests::sphere(10, 24, 13), tests::flipped(tests::sphere(5, 16, 9)));
    decomp::Run run;
    EXPECT_EQ(tets::tetrahedralise(hollow, run).error().code, "tets.failed");
    const auto tets = tets::tetrahedralise_anew(hollow, 2.0, run);
    ASSERT_TRUE(tets.has_value()) << tets.error().text();
    const auto boundary = tets::boundary_surface(tets->points, tets->tets);
    EXPECT_EQ(mesh::check_topology(boundary.surface).components, 2U);
    const double wanted = mesh::volume_mm3(hollow);
    EXPECT_NEAR(mesh::volume_mm3(boundary.surface), wanted, 0.06 * wanted);
}

TEST(Tetrahedralise, FillsTwoSolidsApart) {
    auto second = tests::sphere(5, 16, 9);
    for (auto& p : second.points) {
        p.x() += 30;
    }
    const auto both = tests::joined(tests::sphere(10, 24, 13), second);
    decomp::Run run;
    const auto tets = tets::tetrahedralise(both, run);
    ASSERT_TRUE(tets.has_value()) << tets.error().text();
    expect_filled(both, *tets);
}

TEST(Tetrahedralise, EqualSurfacesGiveEqualTetsWhateverCameBefore) {
    const auto surface = tests::torus(10, 4, 36, 16);
    decomp::Run run;
    const auto first = tets::tetrahedralise(surface, run);
    const auto between = tets::tetrahedralise(tests::sphere(10, 24, 13), run);
    const auto second = tets::tetrahedralise(surface, run);
    ASSERT_TRUE(first && between && second);
    EXPECT_TRUE(first->tets == second->tets);
    EXPECT_TRUE(first->points == second->points);
}

TEST(Tetrahedralise, RefusesAnOpenSurfaceAndOneThatFacesInward) {
    decomp::Run run;
    auto open = tests::sphere(10, 24, 13);
    open.triangles.pop_back();
    EXPECT_EQ(tets::tetrahedralise(open, run).error().code, "tets.bad_surface");
    EXPECT_EQ(tets::tetrahedralise(tests::flipped(tests::sphere(10, 24, 13)), run).error().code,
              "tets.bad_surface");
}

TEST(Tetrahedralise, SaysWhenASurfaceRunsIntoItself) {
    auto second = tests::sphere(10, 24, 13);
    for (auto& p : second.points) {
        p.x() += 8;
    }
    decomp::Run run;
    const auto tets = tets::tetrahedralise(tests::joined(tests::sphere(10, 24, 13), second), run);
    ASSERT_FALSE(tets.has_value());
    EXPECT_EQ(tets.error().code, "tets.failed");
}

TEST(Tetrahedralise, AnewGivesAClosedBoundaryOfNearlyTheSameVolume) {
    const auto surface = tests::torus(10, 4, 36, 16);
    decomp::Run run;
    const auto tets = tets::tetrahedralise_anew(surface, 2.0, run);
    ASSERT_TRUE(tets.has_value()) << tets.error().text();
    const auto boundary = tets::boundary_surface(tets->points, tets->tets);
    const auto topology = mesh::check_topology(boundary.surface);
    EXPECT_TRUE(topology.manifold());
    EXPECT_EQ(topology.euler_characteristic, 0);
    const double wanted = mesh::volume_mm3(surface);
    EXPECT_NEAR(mesh::volume_mm3(boundary.surface), wanted, 0.06 * wanted);
    const auto again = tets::tetrahedralise_anew(surface, 2.0, run);
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(again->points, tets->points);
    EXPECT_EQ(again->tets, tets->tets);
}

}  // namespace
