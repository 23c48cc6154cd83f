// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/samples.h"

#include "cam/check/mill4.h"
#include "tests/support/part_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using cam::check::sample_facets;
using cam::check::Samples;
using decomp::mesh::measure_facets;
using tests::TriMesh;

/// Area and first moment of each facet's pieces.
void expect_same_facets(const TriMesh& mesh, const Samples& samples) {
    const auto facets = measure_facets(mesh);
    std::vector<double> area(mesh.triangles.size(), 0);
    std::vector<Eigen::Vector3d> moment(mesh.triangles.size(), Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < samples.facet.size(); ++i) {
        area[samples.facet[i]] += samples.pieces.area_mm2[i];
        moment[samples.facet[i]] += samples.pieces.area_mm2[i] * samples.pieces.centre[i];
        EXPECT_EQ(samples.pieces.unit[i], facets.unit[samples.facet[i]]);
    }
    for (std::size_t f = 0; f < area.size(); ++f) {
        EXPECT_NEAR(area[f], facets.area_mm2[f], 1e-9 * facets.area_mm2[f]);
        EXPECT_LT((moment[f] / area[f] - facets.centre[f]).norm(), 1e-9);
    }
}

TEST(Samples, PiecesAddUpToTheirFacets) {
    const TriMesh mesh = tests::hook(10, 40, 15);
    const auto samples = sample_facets(mesh, measure_facets(mesh), {.spacing_mm = 1.3});
    EXPECT_EQ(samples.spacing_mm, 1.3);
    EXPECT_GT(samples.facet.size(), 2000U);
    expect_same_facets(mesh, samples);
}

TEST(Samples, SmallFacetsAreTheirOwnSample) {
    const TriMesh mesh = tests::sphere(10, 48, 25);
    const auto facets = measure_facets(mesh);
    const auto samples = sample_facets(mesh, facets, {.spacing_mm = 5});
    EXPECT_EQ(samples.pieces.centre, facets.centre);
    EXPECT_EQ(samples.pieces.area_mm2, facets.area_mm2);
}

TEST(Samples, TooManyPiecesWidenTheSpacing) {
    const TriMesh mesh = tests::box({0, 0, 0}, {100, 100, 100});
    const auto samples =
        sample_facets(mesh, measure_facets(mesh), {.spacing_mm = 0.5, .most_pieces = 1000});
    EXPECT_LE(samples.facet.size(), 1012U);
    EXPECT_GT(samples.facet.size(), 200U);
    EXPECT_GT(samples.spacing_mm, 0.5);
    expect_same_facets(mesh, samples);
}

TEST(Samples, AFacetCountsWhenMoreThanHalfOfItDoes) {
    const TriMesh mesh = tests::box({0, 0, 0}, {10, 10, 10});
    const auto samples = sample_facets(mesh, measure_facets(mesh), {.spacing_mm = 1});
    const auto low = cam::check::share_of(samples, mesh.triangles.size(), [&](std::size_t i) {
        return samples.pieces.centre[i].z() < 2.5;
    });
    // The bottom, and a quarter of each side; but of no triangle of a side more than 7/16.
    EXPECT_NEAR(low.area_mm2, 100 + 4 * 25, 4);
    EXPECT_EQ(low.facets, 2U);
}

/// A floor of one quad with a wall at x = 0: closed below and behind.
TriMesh floor_and_wall() {
    return tests::prism({{-20, -10}, {30, -10}, {30, 0}, {0, 0}, {0, 15}, {-20, 15}}, 40);
}

TEST(Samples, ALargeFacetIsReachedInPart) {
    const TriMesh mesh = floor_and_wall();
    cam::tool::Tool ball;
    ball.shape = cam::tool::Shape::Ball;
    ball.diameter_mm = ball.shank_diameter_mm = 12;
    ball.flute_mm = 40;
    ball.stickout_mm = 80;
    cam::check::Mill4Options options;
    options.axis = Eigen::Vector3d::UnitY();
    options.reach.cell_mm = 0.2;
    options.reach.tolerance_mm = 0.2;
    const auto about = cam::check::check_mill4(tests::whole(mesh), options, {ball}, {}).value();
    // Both strips beside the inner edge, R - sqrt(2 R tol) wide and 40 long.
    const double strip = 6 - std::sqrt(2 * 6 * 0.2);
    EXPECT_NEAR(about.tools[0].unreached.area_mm2, 2 * strip * 40, 0.15 * 2 * strip * 40);
    EXPECT_EQ(about.tools[0].unreached.facets, 0U) << "of no facet most";
}

}  // namespace
