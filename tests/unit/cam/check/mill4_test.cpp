// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/mill4.h"

#include "tests/support/oracle_sight.h"
#include "tests/support/part_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using cam::check::check_mill4;
using cam::check::Mill4Check;
using cam::check::Mill4Options;
using tests::TriMesh;
using tests::whole;

constexpr double kPi = std::numbers::pi;

Mill4Check about(const TriMesh& mesh, const Eigen::Vector3d& axis, bool find_indices = false) {
    Mill4Options options;
    options.axis = axis;
    options.find_indices = find_indices;
    return check_mill4(whole(mesh), options, {}, {}).value();
}

Mill4Check searched(const TriMesh& mesh) {
    Mill4Options options;
    options.find_indices = false;
    options.search = {.samples = 300, .directions = 512, .spread = 150, .refined = 8};
    return check_mill4(whole(mesh), options, {}, {}).value();
}

/// Ends of a sphere: two caps of 1 - 0.99 of the half.
TEST(CheckMill4, ASphereIsSeenWhollyAboutAnyAxis) {
    const auto mesh = tests::sphere(30, 90, 179);
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 2, 3)}) {
        const auto check = about(mesh, axis);
        EXPECT_EQ(check.unseen.facets, 0U);
        EXPECT_NEAR(check.ends.by_area_percent, 1, 0.15);
        EXPECT_EQ(check.uncertain.facets, 0U);
    }
}

TEST(CheckMill4, AHalfSphereAboutEachAxis) {
    const auto mesh = tests::half_sphere(30, 64, 120);
    const auto upright = about(mesh, Eigen::Vector3d::UnitZ());
    EXPECT_EQ(upright.unseen.facets, 0U);
    // The flat is an end: a third of 3 pi r^2, and a cap of 0.01 * 2 pi r^2 at the pole.
    EXPECT_NEAR(upright.ends.by_area_percent, 100.0 / 3 + 2.0 / 3, 0.15);
    // Nothing across the axis sees the flat but along its own plane: a flank can cut it.
    EXPECT_EQ(upright.ends_unseen.facets, 0U);
    const auto lying = about(mesh, Eigen::Vector3d::UnitX());
    EXPECT_EQ(lying.unseen.facets, 0U);
    EXPECT_NEAR(lying.ends.by_area_percent, 2.0 / 3, 0.15);
}

// About its own axis the inner half of a torus (but for the ends) sees only the torus itself:
// [R (pi - 2 d) - 2 r cos d] / 2 pi R of the surface with d = acos 0.99.
TEST(CheckMill4, ATorusHidesItsInnerHalfAboutItsOwnAxis) {
    const double big = 30;
    const double small = 8;
    const auto mesh = tests::torus(big, small, 60, 240);
    const double d = std::acos(cam::check::kEndCosine);
    const double share = (big * (kPi - 2 * d) - 2 * small * std::cos(d)) / (2 * kPi * big);
    EXPECT_NEAR(about(mesh, Eigen::Vector3d::UnitZ()).unseen.by_area_percent, 100 * share, 0.6);
    EXPECT_EQ(about(mesh, Eigen::Vector3d::UnitX()).unseen.facets, 0U);
}

TEST(CheckMill4, ACupHidesItsWallAboutItsOwnAxis) {
    const double outer = 15;
    const double inner = 10;
    const double height = 30;
    const double floor = 10;
    const auto check = about(tests::cup(outer, inner, height, floor, 96), Eigen::Vector3d::UnitZ());
    const double wall = 2 * kPi * inner * (height - floor);
    EXPECT_NEAR(check.unseen.area_mm2, wall, 0.002 * wall);
    const double ends = kPi * (outer * outer + (outer * outer - inner * inner) + inner * inner);
    EXPECT_NEAR(check.ends.area_mm2, ends, 0.002 * ends);
    // Of the ends only the floor of the hole is out of a flank's reach too.
    EXPECT_NEAR(check.ends_unseen.area_mm2, kPi * inner * inner, 0.002 * ends);
}

TEST(CheckMill4, ACylinderOnEachSide) {
    const double r = 10;
    const double l = 40;
    const auto mesh = tests::cylinder_x(r, l, 360);
    const double area = 2 * kPi * r * (l + r);
    const auto along = about(mesh, Eigen::Vector3d::UnitX());
    EXPECT_EQ(along.unseen.facets, 0U);
    EXPECT_NEAR(along.ends.area_mm2, 2 * kPi * r * r, 1e-3 * area);
    const auto across = about(mesh, Eigen::Vector3d::UnitY());
    EXPECT_EQ(across.unseen.facets, 0U);
    // Strips of the mantle within acos 0.99 of the axis, on either side.
    EXPECT_NEAR(across.ends.area_mm2, 4 * std::acos(0.99) * r * l, 0.01 * area);
    EXPECT_NEAR(along.stock.radius_mm, r, 1e-6);
    EXPECT_NEAR(along.stock.length_mm, l, 1e-9);
}

TEST(CheckMill4, AnLIsSeenWholly) {
    EXPECT_EQ(about(tests::el(40, 10, 30), Eigen::Vector3d::UnitY()).unseen.facets, 0U);
}

TEST(CheckMill4, BruteForceSeesTheSame) {
    const auto mesh = tests::hook(10, 40, 15);
    const auto torus = tests::torus(20, 7, 24, 12);
    for (const TriMesh& shape : {mesh, torus}) {
        const auto check = about(shape, Eigen::Vector3d(1, 0.3, 0.2));
        const auto directions =
            cam::check::tool_directions(Eigen::Vector3d(1, 0.3, 0.2).normalized(), 40, 1);
        int differ = 0;
        for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
            bool seen = false;
            for (const auto& d : directions) {
                seen = seen || tests::oracle_sees(shape, i, d, 1e-4);
            }
            differ += seen != (check.facets.seen[i] != 0) ? 1 : 0;
        }
        EXPECT_LE(differ, 1);
    }
}

TEST(CheckMill4, TheSearchFindsTheAxisThatSeesAll) {
    EXPECT_EQ(searched(tests::torus(30, 8, 60, 30)).unseen.facets, 0U);
    const auto cylinder = searched(tests::cylinder_x(10, 60, 90));
    EXPECT_EQ(cylinder.unseen.facets, 0U);
    const auto dumbbell = searched(tests::dumbbell(20, 5, 50, 0, 48));
    EXPECT_LT(dumbbell.unseen.by_area_percent, 0.01);
    // Along a random direction a cup hides its hole; the search finds one across it.
    const auto cup = searched(tests::cup(15, 10, 20, 10, 48));
    EXPECT_LT(cup.unseen.by_area_percent, 2.5);
    EXPECT_LT(std::abs(cup.axes.front().axis.z()), 0.5);
}

TEST(CheckMill4, AFlatEndCostsNothingButTheFloorOfAHoleDoes) {
    // Sawn off in its flat a half sphere needs least stock with the axis upright.
    const auto half = searched(tests::half_sphere(30, 64, 32));
    EXPECT_GT(std::abs(half.axes.front().axis.z()), 0.95);
    EXPECT_LT(half.axes.front().open_end_percent, 0.1);
    const auto cup = about(tests::cup(15, 10, 30, 10, 96), Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(cup.axes.front().open_end_percent, cup.ends_unseen.by_area_percent, 1e-9);
    EXPECT_GT(cup.axes.front().open_end_percent, 2);
}

TEST(CheckMill4, ACutFaceIsAnEndWithoutCost) {
    auto part = whole(tests::cup(15, 10, 30, 10, 96));
    for (std::size_t i = 0; i < part.mesh.triangles.size(); ++i) {
        const auto& t = part.mesh.triangles[i];
        const auto at_floor = [&](std::uint32_t v) { return part.mesh.points[v].z() == 10; };
        if (at_floor(t[0]) && at_floor(t[1]) && at_floor(t[2])) {
            part.sources[i].plane = 0;
        }
    }
    Mill4Options options;
    options.axis = Eigen::Vector3d::UnitZ();
    options.find_indices = false;
    const auto check = check_mill4(part, options, {}, {}).value();
    EXPECT_EQ(check.axes.front().open_end_percent, 0);
    EXPECT_GT(check.ends_unseen.by_area_percent, 2);
}

TEST(CheckMill4, TheIndicesSeeWhatTheyPromise) {
    const auto mesh = tests::hook(10, 40, 15);
    const auto check = about(mesh, Eigen::Vector3d::UnitY(), true);
    EXPECT_TRUE(check.indices.smallest);
    ASSERT_FALSE(check.indices.a_degrees.empty());
    EXPECT_GE(check.indices.covered_percent.back(), 0.995 * check.indices.coverable_percent);
    double sum = 0;
    const auto facets = decomp::mesh::measure_facets(mesh);
    for (std::size_t i = 0; i < facets.unit.size(); ++i) {
        const int k = check.facets.index[i];
        if (k < 0 || check.facets.end[i] != 0) {
            continue;
        }
        const double a = check.indices.a_degrees[static_cast<std::size_t>(k)] * kPi / 180;
        const Eigen::Vector3d seen_from =
            check.setup_from_model.inverse().turn(cam::check::tool_direction(a, 1));
        EXPECT_GT(facets.unit[i].dot(seen_from), 0);
        sum += facets.area_mm2[i];
    }
    EXPECT_NEAR(100 * sum / facets.total_mm2, check.indices.covered_percent.back(), 1e-6);
}

TEST(CheckMill4, ABoxNeedsTwoIndicesAndACylinderThree) {
    const auto box = about(tests::box({0, 0, 0}, {40, 10, 20}), Eigen::Vector3d::UnitX(), true);
    EXPECT_EQ(box.indices.a_degrees.size(), 2U) << "edge on: each sees two faces";
    const auto cylinder = about(tests::cylinder_x(10, 40, 120), Eigen::Vector3d::UnitX(), true);
    EXPECT_EQ(cylinder.indices.a_degrees.size(), 3U);
}

TEST(CheckMill4, ABallReachesLessThanARayAndAThickOneLess) {
    const auto mesh = tests::dumbbell(15, 5, 30, 0, 32);
    cam::tool::Tool thin;
    thin.name = "thin";
    thin.shape = cam::tool::Shape::Ball;
    thin.diameter_mm = thin.shank_diameter_mm = 2;
    thin.flute_mm = 30;
    thin.stickout_mm = 40;
    cam::tool::Tool thick = thin;
    thick.name = "thick";
    thick.diameter_mm = thick.shank_diameter_mm = 30;
    Mill4Options options;
    options.axis = Eigen::Vector3d::UnitZ();
    options.angles = 6;
    options.reach.cell_mm = 0.4;
    options.reach.tolerance_mm = 0.4;
    const auto check = check_mill4(whole(mesh), options, {thin, thick}, {}).value();
    EXPECT_LE(check.tools[0].unreached.area_mm2, check.tools[1].unreached.area_mm2);
    EXPECT_GE(check.tools[0].unreached.area_mm2, check.unseen.area_mm2 - 1e-9);
    EXPECT_GE(check.tools[0].unreached_at_indices.area_mm2, check.tools[0].unreached.area_mm2);
    EXPECT_LT(check.tools[0].unreached.by_area_percent, 1);
    EXPECT_GT(check.tools[1].unreached.by_area_percent, 5);
}

TEST(CheckMill4, ADirectionOfNothingIsNoAxis) {
    Mill4Options options;
    options.axis = Eigen::Vector3d::Zero();
    const auto check = check_mill4(whole(tests::sphere(1, 8, 5)), options, {}, {});
    ASSERT_FALSE(check.has_value());
    EXPECT_EQ(check.error().code, "check.axis");
}

TEST(CheckMill4, OneThreadAndTwoChooseTheSame) {
    decomp::Run two;
    two.jobs = 2;
    const auto part = whole(tests::hook(10, 40, 15));
    const auto a = check_mill4(part, {}, {}, {}).value();
    const auto b = check_mill4(part, {}, {}, two).value();
    EXPECT_EQ(a.axes.front().axis, b.axes.front().axis);
    EXPECT_EQ(a.indices.a_degrees, b.indices.a_degrees);
    EXPECT_EQ(a.facets.index, b.facets.index);
}

}  // namespace
