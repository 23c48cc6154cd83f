// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/decomp/cut/support.h"

using decomp::cut::Complex;
using decomp::mesh::check_topology;
using decomp::mesh::volume_mm3;
using decomp::part::Plane;
using tests::box;
using tests::complex_of;
using tests::expect_sound;
using tests::split_all;

namespace {

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kY = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

/// An L of three unit cubes in the plane z = 0 … 1, as one prism of 12 points.
tests::TriMesh l_block() {
    tests::TriMesh mesh;
    const std::vector<Eigen::Vector2d> outline{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (const double z : {0.0, 1.0}) {
        for (const auto& p : outline) {
            mesh.points.emplace_back(p.x(), p.y(), z);
        }
    }
    for (const decomp::mesh::Triangle& t :
         std::vector<decomp::mesh::Triangle>{{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}}) {
        mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
        mesh.triangles.push_back({t[0], t[2], t[1]});
    }
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t j = (i + 1) % 6;
        mesh.triangles.push_back({i, j, j + 6});
        mesh.triangles.push_back({i, j + 6, i + 6});
    }
    return mesh;
}

}  // namespace

TEST(Complex, BoxInHalvesHasTwoBoxes) {
    const auto mesh = box({0, 0, 0}, {2, 1, 1});
    Complex complex = complex_of(mesh);
    const auto ids = complex.split(0, {kX, 0.75});
    ASSERT_TRUE(ids.has_value());
    EXPECT_EQ(*ids, (std::vector<std::int32_t>{0, 1}));
    EXPECT_EQ(complex.exact_volume_mm3(0), "3/4");
    EXPECT_EQ(complex.exact_volume_mm3(1), "5/4");
    EXPECT_DOUBLE_EQ(complex.volume_mm3(1), 1.25);
    const auto assembly = expect_sound(complex, mesh);
    ASSERT_EQ(assembly.interfaces.size(), 1U);
    EXPECT_DOUBLE_EQ(assembly.interfaces[0].area_mm2, 1);
    EXPECT_EQ(assembly.parts[1].id, "P02");
}

TEST(Complex, PlaneThatMissesLeavesTheRegion) {
    Complex complex = complex_of(box({0, 0, 0}, {1, 1, 1}));
    EXPECT_EQ(complex.split(0, {kX, 3}).value(), std::vector<std::int32_t>{0});
    EXPECT_EQ(complex.split(0, {kX, 1}).value(), std::vector<std::int32_t>{0});
    EXPECT_EQ(complex.region_count(), 1);
}

TEST(Complex, GridOfThreeDirectionsMakesEightEqualBoxes) {
    const auto mesh = box({0, 0, 0}, {2, 2, 2});
    Complex complex = complex_of(mesh);
    for (const auto& axis : {kX, kY, kZ}) {
        split_all(complex, {axis, 1});
    }
    EXPECT_EQ(complex.region_count(), 8);
    for (std::int32_t region = 0; region < 8; ++region) {
        EXPECT_EQ(complex.exact_volume_mm3(region), "1/1");
    }
    const auto assembly = expect_sound(complex, mesh);
    EXPECT_EQ(assembly.planes.size(), 3U);
    EXPECT_EQ(assembly.interfaces.size(), 12U);
}

TEST(Complex, ObliqueCutsOfASphereAreSound) {
    const auto mesh = tests::sphere(10, 40, 19);
    Complex complex = complex_of(mesh);
    split_all(complex, {{0.3, 1, 0.17}, 0.5});
    split_all(complex, {{1, -0.2, 0.4}, -1.25});
    split_all(complex, {{0.1, 0.2, 1}, 2});
    EXPECT_EQ(complex.region_count(), 8);
    expect_sound(complex, mesh);
}

TEST(Complex, TorusCutAcrossIsTwoHalfRingsAndAlongItsPlaneTwoRings) {
    const auto mesh = tests::torus(10, 3, 48, 24);
    Complex across = complex_of(mesh);
    EXPECT_EQ(across.split(0, {{1, 0.01, 0}, 0.3}).value().size(), 2U);
    expect_sound(across, mesh);
    Complex along = complex_of(mesh);
    EXPECT_EQ(along.split(0, {{0.01, 0.02, 1}, 0.1}).value().size(), 2U);
    const auto rings = expect_sound(along, mesh);
    EXPECT_EQ(check_topology(rings.parts[0].mesh).euler_characteristic, 0);
}

TEST(Complex, SidesComeApartIntoComponents) {
    const auto mesh = tests::torus(10, 3, 48, 24);
    Complex complex = complex_of(mesh);
    const auto halves = complex.split(0, {{1, 0.01, 0}, 8.5});  // a cap of the ring, and the rest
    ASSERT_EQ(halves->size(), 2U);
    const auto ends = complex.split(0, {{0, 1, 0.003}, 0.01});
    ASSERT_EQ(ends->size(), 2U);
    const auto both = complex.split(1, {{0, 1, 0.003}, 0.01});
    ASSERT_EQ(both->size(), 2U);
    expect_sound(complex, mesh);
    Complex u = complex_of(mesh);
    ASSERT_EQ(u.split(0, {{1, 0.01, 0}, 0.02})->size(), 2U);
    EXPECT_EQ(u.split(1, {{1, 0.01, 0}, 3.02})->size(), 3U);  // two stumps below, an arc above
    expect_sound(u, mesh);
}

TEST(Complex, CutInAFlatFaceOfAnLIsExact) {
    const auto mesh = l_block();
    Complex complex = complex_of(mesh);
    ASSERT_EQ(complex.split(0, {kX, 1})->size(), 2U);  // contains the inner wall x = 1
    EXPECT_EQ(complex.exact_volume_mm3(0), "2/1");
    EXPECT_EQ(complex.exact_volume_mm3(1), "1/1");
    ASSERT_EQ(complex.split(0, {kY, 1})->size(), 2U);  // contains the inner wall y = 1
    const auto assembly = expect_sound(complex, mesh);
    EXPECT_EQ(assembly.interfaces.size(), 2U);
    for (const auto& interface : assembly.interfaces) {
        EXPECT_DOUBLE_EQ(interface.area_mm2, 1);
    }
}

TEST(Complex, CutThroughVerticesAndAlongEdgesIsExact) {
    const auto mesh = box({0, 0, 0}, {1, 1, 1});
    Complex diagonal = complex_of(mesh);
    ASSERT_EQ(diagonal.split(0, {{1, -1, 0}, 0})->size(),
              2U);  // along two edges and two face diagonals
    EXPECT_EQ(diagonal.exact_volume_mm3(0), "1/2");
    expect_sound(diagonal, mesh);
    Complex corner = complex_of(mesh);
    ASSERT_EQ(corner.split(0, {{1, 1, 1}, 1})->size(), 2U);  // through three vertices
    EXPECT_EQ(corner.exact_volume_mm3(0), "1/6");
    expect_sound(corner, mesh);
    auto ball = tests::sphere(10, 32, 15);
    for (auto& p : ball.points) {
        p = (p * 1048576).array().round() / 1048576;  // takes y = 1e-15 to 0
    }
    Complex poles = complex_of(ball);
    ASSERT_EQ(poles.split(0, {{0, 1, 0}, 0})->size(), 2U);  // along meridians, through both poles
    expect_sound(poles, ball);
}

TEST(Complex, NearlyEqualPlanesStayExact) {
    const auto mesh = tests::sphere(10, 64, 31);
    Complex complex = complex_of(mesh);
    for (int i = 0; i < 10; ++i) {
        split_all(complex,
                  {{0.25 + i / 1024.0, 1, 0.125 - i / 512.0}, 0});  // all through one line, exactly
    }
    EXPECT_TRUE(complex.volumes_sum_exactly());
    EXPECT_EQ(complex.region_count(), 20);
}

TEST(Complex, HollowBallIsOneRegionAndItsHalvesHaveRings) {
    const auto mesh =
        tests::joined(tests::sphere(10, 24, 11), tests::flipped(tests::sphere(6, 24, 11)));
    Complex complex = complex_of(mesh);
    EXPECT_EQ(complex.region_count(), 1);
    ASSERT_EQ(complex.split(0, {{0.1, 0.2, 1}, 0})->size(), 2U);
    const auto assembly = expect_sound(complex, mesh);
    EXPECT_EQ(check_topology(assembly.parts[0].mesh).euler_characteristic, 2);
}

TEST(Complex, AVoidStaysWithTheRegionAroundIt) {
    const auto voids = tests::joined(tests::flipped(box({1, 1, 1}, {2, 2, 2})),
                                     tests::flipped(box({7, 1, 1}, {9, 2, 2})));
    const auto mesh = tests::joined(box({0, 0, 0}, {10, 3, 3}), voids);
    Complex complex = complex_of(mesh);
    EXPECT_EQ(complex.region_count(), 1);
    ASSERT_EQ(complex.split(0, {kX, 5})->size(), 2U);
    EXPECT_EQ(complex.exact_volume_mm3(0), "44/1");
    EXPECT_EQ(complex.exact_volume_mm3(1), "43/1");
    expect_sound(complex, mesh);
}

TEST(Complex, ABodyInsideAVoidIsARegionOfItsOwn) {
    const auto mesh = tests::joined(
        tests::joined(box({0, 0, 0}, {9, 9, 9}), tests::flipped(box({1, 1, 1}, {8, 8, 8}))),
        tests::joined(box({2, 2, 2}, {7, 7, 7}), tests::flipped(box({3, 3, 3}, {6, 6, 6}))));
    Complex complex = complex_of(mesh);
    EXPECT_EQ(complex.region_count(), 2);
    EXPECT_EQ(complex.exact_volume_mm3(0), "386/1");
    EXPECT_EQ(complex.exact_volume_mm3(1), "98/1");
    split_all(complex, {{1, 0.1, 0.2}, 5});
    EXPECT_EQ(complex.region_count(), 4);
    expect_sound(complex, mesh);
}

TEST(Complex, MergingUndoesASplit) {
    const auto mesh = tests::sphere(10, 24, 11);
    Complex complex = complex_of(mesh);
    split_all(complex, {{0.1, 0.2, 1}, 1});
    split_all(complex, {{1, 0.2, 0.1}, 2});
    ASSERT_EQ(complex.region_count(), 4);
    complex.merge(0, 1);
    complex.merge(0, 2);
    complex.merge(0, 3);
    EXPECT_TRUE(complex.is_empty(3));
    const auto assembly = expect_sound(complex, mesh);
    ASSERT_EQ(assembly.parts.size(), 1U);
    EXPECT_TRUE(assembly.planes.empty());
}

TEST(Complex, AMergedRegionCanBeCutAgain) {
    const auto mesh = tests::sphere(10, 24, 11);
    Complex complex = complex_of(mesh);
    split_all(complex, {{0.1, 0.2, 1}, 0.93});
    split_all(complex, {{1, 0.2, 0.1}, 2});
    complex.merge(0, 3);
    split_all(complex, {{0.4, 1, 0.3}, 0.5});
    split_all(complex, {{0.4, 0.1, -0.8}, 0.25});
    expect_sound(complex, mesh);
}

TEST(Complex, NeighboursOfACutCapGetTheSameVertices) {
    const auto mesh = box({0, 0, 0}, {4, 4, 4});
    Complex complex = complex_of(mesh);
    ASSERT_EQ(complex.split(0, {kZ, 2})->size(), 2U);
    ASSERT_EQ(complex.split(1, {{1, 0.1, 0.3}, 2})->size(), 2U);  // only the upper half
    const auto assembly = expect_sound(complex, mesh);
    EXPECT_EQ(assembly.interfaces.size(), 3U);
}

TEST(Complex, CopiesAreIndependent) {
    Complex complex = complex_of(box({0, 0, 0}, {1, 1, 1}));
    Complex copy = complex;
    ASSERT_EQ(copy.split(0, {kX, 0.5})->size(), 2U);
    EXPECT_EQ(complex.region_count(), 1);
    EXPECT_EQ(complex.exact_volume_mm3(0), "1/1");
}

TEST(Complex, RegionEqualsThePartThatIsWritten) {
    const auto mesh = tests::torus(10, 3, 48, 24);
    Complex complex = complex_of(mesh);
    split_all(complex, {{1, 0.1, 0.2}, 0.5});
    const auto assembly = expect_sound(complex, mesh);
    const auto alone = complex.region(1);
    EXPECT_EQ(alone.mesh.triangles, assembly.parts[1].mesh.triangles);
    EXPECT_EQ(alone.mesh.points, assembly.parts[1].mesh.points);
}

TEST(Complex, OpenMeshIsRefused) {
    auto mesh = box({0, 0, 0}, {1, 1, 1});
    mesh.triangles.pop_back();
    const auto made = Complex::from_volume(mesh);
    ASSERT_FALSE(made.has_value());
    EXPECT_EQ(made.error().code, "cut.not_a_volume");
    EXPECT_FALSE(Complex::from_volume({}).has_value());
    EXPECT_FALSE(Complex::from_volume(tests::flipped(box({0, 0, 0}, {1, 1, 1}))).has_value());
}

TEST(Complex, AFailedSplitChangesNothing) {
    const auto mesh = tests::joined(box({0, 0, 0}, {2, 2, 2}),
                                    box({1, 1, 1}, {3, 3, 3}));  // two boxes that overlap
    Complex complex = complex_of(mesh);
    complex.merge(0, 1);
    const auto ids = complex.split(0, {kX, 1.5});
    ASSERT_FALSE(ids.has_value());
    EXPECT_EQ(ids.error().code, "cut.crossing_constraints");
    EXPECT_EQ(complex.exact_volume_mm3(0), "16/1");
    EXPECT_TRUE(complex.volumes_sum_exactly());
    EXPECT_EQ(complex.split(0, {kX, 0.5})->size(), 3U);
}

TEST(Complex, APlaneWithoutANormalIsRefused) {
    Complex complex = complex_of(box({0, 0, 0}, {1, 1, 1}));
    EXPECT_EQ(complex.split(0, {Eigen::Vector3d::Zero(), 0}).error().code, "cut.bad_plane");
}

TEST(Complex, TrianglesWithoutAreaAreDissolved) {
    // The face y = 0 of a box with a point in the middle of its lower edge that the neighbour does
    // not see.
    auto mesh = box({0, 0, 0}, {2, 1, 1});
    mesh.points.emplace_back(1, 0, 0);  // between points 0 and 4
    for (auto& t : mesh.triangles) {
        if (t == decomp::mesh::Triangle{0, 4, 5}) {
            t = {0, 8, 5};
        }
    }
    mesh.triangles.push_back({8, 4, 5});
    mesh.triangles.push_back({0, 4, 8});
    Complex complex = complex_of(mesh);
    ASSERT_EQ(complex.split(0, {kX, 0.5})->size(), 2U);
    EXPECT_EQ(complex.exact_volume_mm3(1), "3/2");
    const auto assembly = expect_sound(complex, mesh);
    EXPECT_EQ(check_topology(assembly.parts[1].mesh).degenerate_triangles, 0U);
}

TEST(Complex, NudgeLeavesVerticesAloneOrMeetsThemExactly) {
    const Complex complex = complex_of(box({0, 0, 0}, {1, 1, 1}));
    EXPECT_EQ(complex.nudged_off_vertices(0, {kX, 0.5}, 1e-3).offset_mm, 0.5);
    EXPECT_EQ(complex.nudged_off_vertices(0, {kX, 1.0}, 1e-3).offset_mm, 1.0);  // exactly on it
    EXPECT_NEAR(complex.nudged_off_vertices(0, {kX, 1e-9}, 1e-3).offset_mm, 1e-3, 1e-6);
}

TEST(Complex, BytesDoNotDependOnJobs) {
    const auto mesh = tests::torus(10, 3, 48, 24);
    Complex complex = complex_of(mesh);
    split_all(complex, {{1, 0.1, 0.2}, 0.5});
    split_all(complex, {{0.1, 1, 0.2}, 0.5});
    const auto order = tests::all_regions(complex);
    decomp::Run two;
    two.jobs = 2;
    const auto a = complex.assemble(order, decomp::Run{});
    const auto b = complex.assemble(order, two);
    ASSERT_TRUE(a.has_value() && b.has_value());
    for (std::size_t i = 0; i < a->parts.size(); ++i) {
        EXPECT_EQ(a->parts[i].mesh.points, b->parts[i].mesh.points);
        EXPECT_EQ(a->parts[i].mesh.triangles, b->parts[i].mesh.triangles);
    }
}

TEST(Complex, RoundingThatMakesAPartIntersectItselfNamesThePlane) {
    // A plane that passes 1e-16 beside points of the ball, and one well away from them.
    const auto mesh = tests::sphere(10, 32, 15);
    Complex complex = complex_of(mesh);
    ASSERT_EQ(complex.split(0, {kZ, 3.3})->size(), 2U);
    ASSERT_EQ(complex.split(0, {kY, 0})->size(), 2U);
    const auto assembly = complex.assemble(tests::all_regions(complex), decomp::Run{});
    ASSERT_FALSE(assembly.has_value());
    EXPECT_EQ(assembly.error().code, "cut.rounding_intersects");
    EXPECT_NE(assembly.error().where.find("plane 1"), std::string::npos) << assembly.error().where;
    Complex moved = complex_of(mesh);
    ASSERT_EQ(moved.split(0, moved.nudged_off_vertices(0, {kY, 0}, 1e-3))->size(), 2U);
    expect_sound(moved, mesh);
}

TEST(Complex, EveryRegionMustBeListedOnce) {
    Complex complex = complex_of(box({0, 0, 0}, {1, 1, 1}));
    split_all(complex, {kX, 0.5});
    EXPECT_EQ(complex.assemble({0}, decomp::Run{}).error().code, "cut.bad_order");
    EXPECT_EQ(complex.assemble({0, 0}, decomp::Run{}).error().code, "cut.bad_order");
    EXPECT_EQ(complex.assemble({0, 1, 7}, decomp::Run{}).error().code, "cut.bad_order");
    EXPECT_EQ(complex.assemble({1, 0}, decomp::Run{})->parts[0].sources.size(), 20U);
}

TEST(Complex, ACancelledAssemblySaysSo) {
    Complex complex = complex_of(box({0, 0, 0}, {1, 1, 1}));
    std::stop_source stop;
    stop.request_stop();
    decomp::Run run;
    run.stop = stop.get_token();
    EXPECT_EQ(complex.assemble({0}, run).error().code, "run.cancelled");
}
