// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/decomp/cut/support.h"

using decomp::cut::Complex;
using tests::complex_of;
using tests::expect_sound;

namespace {

/// A prism along Y over a polygon in (x, z), counter-clockwise seen from -Y, given with its
/// triangles.
tests::TriMesh prism(const std::vector<Eigen::Vector2d>& outline,
                     const std::vector<decomp::mesh::Triangle>& caps) {
    tests::TriMesh mesh;
    const auto count = static_cast<std::uint32_t>(outline.size());
    for (const double y : {0.0, 3.0}) {
        for (const auto& p : outline) {
            mesh.points.emplace_back(p.x(), y, p.y());
        }
    }
    for (const auto& t : caps) {
        mesh.triangles.push_back(t);
        mesh.triangles.push_back({t[0] + count, t[2] + count, t[1] + count});
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t j = (i + 1) % count;
        mesh.triangles.push_back({j, i, i + count});
        mesh.triangles.push_back({j, i + count, j + count});
    }
    return mesh;
}

}  // namespace

TEST(Pinch, GrooveDownToThePlaneTakesTheUpperHalfApart) {
    // A block with a V groove from the top whose bottom line lies in the plane z = 1.
    const auto mesh = prism({{0, 0}, {4, 0}, {4, 2}, {3, 2}, {2, 1}, {1, 2}, {0, 2}},
                            {{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 4, 5}, {0, 5, 6}});
    Complex complex = complex_of(mesh);
    EXPECT_EQ(complex.exact_volume_mm3(0), "21/1");
    const auto ids = complex.split(0, {Eigen::Vector3d::UnitZ(), 1});
    ASSERT_TRUE(ids.has_value());
    ASSERT_EQ(ids->size(), 3U);
    EXPECT_EQ(complex.exact_volume_mm3(0), "12/1");
    EXPECT_EQ(complex.exact_volume_mm3(1), "9/2");
    EXPECT_EQ(complex.exact_volume_mm3(2), "9/2");
    expect_sound(complex, mesh);
}

TEST(Pinch, PitDownToThePlaneIsSplitByUmbrella) {
    // A block with a pyramid-shaped pit whose tip lies in the plane z = 1: the upper half touches
    // itself in one point.
    tests::TriMesh mesh = tests::box({0, 0, 0}, {4, 4, 3});
    std::erase_if(mesh.triangles, [&](const auto& t) {
        return mesh.points[t[0]].z() == 3 && mesh.points[t[1]].z() == 3 &&
               mesh.points[t[2]].z() == 3;
    });
    const auto base = static_cast<std::uint32_t>(mesh.points.size());
    for (const auto& p : {Eigen::Vector3d(1, 1, 3), {3, 1, 3}, {3, 3, 3}, {1, 3, 3}, {2, 2, 1}}) {
        mesh.points.push_back(p);
    }
    const std::array<std::uint32_t, 4> outer{1, 5, 7, 3};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t j = (i + 1) % 4;
        mesh.triangles.push_back({outer[i], outer[j], base + j});
        mesh.triangles.push_back({outer[i], base + j, base + i});
        mesh.triangles.push_back({base + i, base + j, base + 4});
    }
    Complex complex = complex_of(mesh);
    ASSERT_EQ(complex.split(0, {Eigen::Vector3d::UnitZ(), 1})->size(), 2U);
    const auto assembly = expect_sound(complex, mesh);
    ASSERT_EQ(assembly.parts.size(), 2U);
    const auto tips = [&](const auto& part) {
        return std::count(part.mesh.points.begin(), part.mesh.points.end(),
                          Eigen::Vector3d(2, 2, 1));
    };
    EXPECT_EQ(tips(assembly.parts[0]), 1);
    EXPECT_EQ(tips(assembly.parts[1]), 2);
    Complex further = complex;  // through the lone vertex
    for (const std::int32_t region : {0, 1}) {
        ASSERT_EQ(further.split(region, {{1, 0.5, 0}, 3})->size(), 2U);
    }
    expect_sound(further, mesh);
}

TEST(Pinch, VoidThatTouchesTheCutAlongAnEdgeIsOpened) {
    // The lower half touches itself along an edge of the void that lies inside the cap.
    const auto mesh = tests::joined(tests::box({0, 0, 0}, {6, 6, 6}),
                                    tests::flipped(tests::box({2, 2, 2}, {3, 4, 3})));
    Complex complex = complex_of(mesh);
    ASSERT_EQ(complex.split(0, {{1, 0, 1}, 6})->size(), 2U);
    const auto assembly = expect_sound(complex, mesh);
    ASSERT_EQ(assembly.parts.size(), 2U);
    const auto middles = [&](const auto& part) {
        return std::count(part.mesh.points.begin(), part.mesh.points.end(),
                          Eigen::Vector3d(3, 3, 3));
    };
    EXPECT_EQ(middles(assembly.parts[0]), 2);
    EXPECT_EQ(middles(assembly.parts[1]), 1);
    EXPECT_EQ(complex.planes().size(), 1U);
}

TEST(Pinch, TwoBodiesThatTouchAlongAnEdgeAreTwoRegions) {
    // Two boxes with the common edge x = 1, y = 1: four triangles at each of its pieces.
    const auto mesh =
        tests::joined(tests::box({0, 0, 0}, {1, 1, 1}), tests::box({1, 1, 0}, {2, 2, 1}));
    Complex complex = complex_of(mesh);
    EXPECT_EQ(complex.region_count(), 2);
    EXPECT_EQ(complex.exact_volume_mm3(1), "1/1");
    tests::split_all(complex, {{0.2, 0.1, 1}, 0.7});
    EXPECT_EQ(complex.region_count(), 4);
    expect_sound(complex, mesh);
}

TEST(Pinch, RegionThatTouchesItselfAlongAnEdgeIsWrittenAsAManifold) {
    Complex complex = complex_of(tests::box({0, 0, 0}, {2, 2, 2}));
    for (const auto& plane : {decomp::part::Plane{Eigen::Vector3d::UnitZ(), 1},
                              {Eigen::Vector3d::UnitX(), 1},
                              {Eigen::Vector3d::UnitY(), 1}}) {
        tests::split_all(complex, plane);
    }
    ASSERT_EQ(complex.region_count(), 8);
    // Lower cubes on one diagonal join the four upper ones: they touch along a vertical edge.
    std::vector<std::int32_t> joined;
    for (std::int32_t region = 0; region < 8; ++region) {
        const auto part = complex.region(region);
        const Eigen::Vector3d centre = decomp::mesh::bounds(part.mesh).center();
        if (centre.z() > 1 || (centre.x() > 1) == (centre.y() > 1)) {
            joined.push_back(region);
        }
    }
    ASSERT_EQ(joined.size(), 6U);
    for (std::size_t i = 1; i < joined.size(); ++i) {
        complex.merge(joined[0], joined[i]);
    }
    EXPECT_EQ(complex.exact_volume_mm3(joined[0]), "6/1");
    const auto part = complex.region(joined[0]);
    EXPECT_TRUE(decomp::mesh::check_topology(part.mesh).manifold());
    EXPECT_TRUE(complex.volumes_sum_exactly());
    tests::split_all(complex, {{0.3, 0.2, 1}, 0.8});
    EXPECT_TRUE(complex.volumes_sum_exactly());
    for (const std::int32_t region : tests::all_regions(complex)) {
        EXPECT_TRUE(decomp::mesh::check_topology(complex.region(region).mesh).manifold());
    }
}
