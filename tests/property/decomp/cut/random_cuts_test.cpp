// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/rng.h"
#include "tests/unit/decomp/cut/support.h"

#include <gmpxx.h>

using decomp::Rng;
using decomp::cut::Complex;
using decomp::part::Plane;
using tests::TriMesh;

namespace {

TriMesh shape(Rng& rng) {
    switch (rng.below(6)) {
        case 0:
            return tests::torus(10, 3, 24 + static_cast<std::uint32_t>(rng.below(20)), 16);
        case 1:
            return tests::sphere(10, 12 + static_cast<std::uint32_t>(rng.below(30)), 11);
        case 2:
            return tests::box({-4, -6, -3}, {8, 6, 5});
        case 3:
            return tests::joined(tests::sphere(10, 24, 11),
                                 tests::flipped(tests::sphere(6, 16, 9)));
        case 4:
            return tests::joined(tests::torus(10, 3, 30, 12), tests::torus(20, 2, 30, 12));
        default:
            return tests::joined(tests::box({-8, -8, -8}, {8, 8, 8}),
                                 tests::joined(tests::flipped(tests::box({-2, -2, -3}, {2, 1, 3})),
                                               tests::flipped(tests::torus(5, 1, 20, 9))));
    }
}

/// A plane in any direction, or through a point of the shape at right angles to an axis.
Plane plane(Rng& rng, const TriMesh& mesh) {
    if (rng.below(4) == 0) {
        const auto axis = static_cast<Eigen::Index>(rng.below(3));
        return {Eigen::Vector3d::Unit(axis), mesh.points[rng.below(mesh.points.size())][axis]};
    }
    const Eigen::Vector3d normal(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    return {normal.normalized(), rng.uniform(-7, 7)};
}

mpq_class exact_sum(const Complex& complex) {
    mpq_class sum = 0;
    for (const std::int32_t region : tests::all_regions(complex)) {
        sum += mpq_class(complex.exact_volume_mm3(region));
    }
    return sum;
}

}  // namespace

class RandomCuts : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomCuts, PartitionExactlyAndWriteSoundParts) {
    Rng rng(GetParam());
    const TriMesh mesh = shape(rng);
    Complex complex = tests::complex_of(mesh);
    const mpq_class whole = exact_sum(complex);
    const double step = 3e-5 * decomp::mesh::diagonal_mm(mesh);
    for (int i = 0; i < 6; ++i) {
        const std::vector<std::int32_t> regions = tests::all_regions(complex);
        const std::int32_t region = regions[rng.below(regions.size())];
        const Plane cut = complex.nudged_off_vertices(region, plane(rng, mesh), step);
        const auto ids = complex.split(region, cut);
        ASSERT_TRUE(ids.has_value()) << ids.error().text();
        if (ids->size() > 1 && rng.below(3) == 0) {
            complex.merge((*ids)[1], (*ids)[0]);
        }
    }
    EXPECT_EQ(exact_sum(complex), whole);
    tests::expect_sound(complex, mesh);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomCuts, testing::Range<std::uint64_t>(1, 61));

class CoplanarCuts : public testing::TestWithParam<std::uint64_t> {};

/// Random polycubes merged from a grid, then cut again along and between the grid's planes.
TEST_P(CoplanarCuts, OfRandomPolycubesPartitionExactly) {
    Rng rng(GetParam());
    const TriMesh mesh = tests::box({0, 0, 0}, {3, 3, 3});
    Complex complex = tests::complex_of(mesh);
    for (int axis = 0; axis < 3; ++axis) {
        for (const double at : {1.0, 2.0}) {
            tests::split_all(complex, {Eigen::Vector3d::Unit(axis), at});
        }
    }
    ASSERT_EQ(complex.region_count(), 27);
    for (int i = 1; i < 12; ++i) {
        complex.merge(0, 2 * i);
    }
    for (int i = 0; i < 8; ++i) {
        const auto regions = tests::all_regions(complex);
        complex.merge(regions[rng.below(regions.size())], regions[rng.below(regions.size())]);
    }
    const std::array<double, 5> offsets{0.5, 1, 1.5, 2, 2.5};
    for (int i = 0; i < 4; ++i) {
        const auto axis = static_cast<Eigen::Index>(rng.below(3));
        tests::split_all(complex, {Eigen::Vector3d::Unit(axis), offsets.at(rng.below(5))});
        tests::split_all(complex,
                         {{1, rng.below(2) == 0 ? -1.0 : 1.0, 0}, offsets.at(rng.below(5))});
    }
    EXPECT_TRUE(complex.volumes_sum_exactly());
    EXPECT_EQ(exact_sum(complex), 27);
    for (const std::int32_t region : tests::all_regions(complex)) {
        EXPECT_TRUE(decomp::mesh::check_topology(complex.region(region).mesh).manifold());
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CoplanarCuts, testing::Range<std::uint64_t>(1, 41));

class ThroughVertices : public testing::TestWithParam<std::uint64_t> {};

namespace {

/// Points on a lattice of whole numbers, so that planes through three of them are exact.
TriMesh on_lattice(TriMesh mesh, double scale) {
    for (auto& p : mesh.points) {
        p = (p * scale).array().round();
    }
    return mesh;
}

Plane through_three_points(Rng& rng, const TriMesh& mesh) {
    while (true) {
        const Eigen::Vector3d& a = mesh.points[rng.below(mesh.points.size())];
        const Eigen::Vector3d& b = mesh.points[rng.below(mesh.points.size())];
        const Eigen::Vector3d& c = mesh.points[rng.below(mesh.points.size())];
        const Eigen::Vector3d normal = (b - a).cross(c - a);
        if (!normal.isZero(0)) {
            return {normal, normal.dot(a)};
        }
    }
}

/// Cuts by planes through three points each; whatever touches whatever, the topology must hold.
void cut_through_vertices(const TriMesh& mesh, Rng& rng) {
    Complex complex = tests::complex_of(mesh);
    const mpq_class whole = exact_sum(complex);
    for (int i = 0; i < 5; ++i) {
        tests::split_all(complex, through_three_points(rng, mesh));
    }
    EXPECT_TRUE(complex.volumes_sum_exactly());
    EXPECT_EQ(exact_sum(complex), whole);
    for (const std::int32_t region : tests::all_regions(complex)) {
        EXPECT_TRUE(decomp::mesh::check_topology(complex.region(region).mesh).manifold());
        EXPECT_GT(mpq_class(complex.exact_volume_mm3(region)), 0);
    }
    const auto assembly = complex.assemble(tests::all_regions(complex), decomp::Run{});
    EXPECT_TRUE(assembly || assembly.error().code == "cut.rounding_intersects")
        << assembly.error().text();
}

}  // namespace

TEST_P(ThroughVertices, ExactlyOnTheLattice) {
    Rng rng(GetParam());
    cut_through_vertices(on_lattice(tests::torus(10, 4, 10, 8), 16), rng);
    cut_through_vertices(on_lattice(tests::sphere(10, 10, 7), 16), rng);
    cut_through_vertices(tests::joined(tests::box({-5, -5, -5}, {5, 5, 5}),
                                       tests::flipped(tests::box({-2, -3, -1}, {3, 1, 4}))),
                         rng);
}

TEST_P(ThroughVertices, AHairBesideThem) {
    Rng rng(GetParam());
    cut_through_vertices(tests::torus(10, 4, 10, 8), rng);
    cut_through_vertices(tests::sphere(10, 10, 7), rng);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ThroughVertices, testing::Range<std::uint64_t>(1, 31));
