// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/plan/workpiece.h"

#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using decomp::plan::Plan;
using decomp::plan::Step;
using decomp::plan::Workpiece;
using Names = std::vector<std::string>;

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();

Step cut(const std::string& region, double x, Names names = {}) {
    return {Step::Kind::Cut, region, {kX, x}, {}, std::move(names), "", "plan.toml:9:1"};
}

Step merge(const std::string& region, Names names) {
    return {Step::Kind::Merge, region, {}, {}, std::move(names), "", "plan.toml:9:1"};
}

/// A bar of 100 mm along X.
Workpiece bar() { return *Workpiece::of(tests::box({0, 0, 0}, {100, 10, 10})); }

double volume(const Workpiece& piece, const std::string& name) {
    return piece.complex().volume_mm3(piece.region(name));
}

TEST(Workpiece, PiecesAreCalledAsTheStepSaysBelowThePlaneFirst) {
    Workpiece piece = bar();
    const auto names = piece.carry_out(cut("r0", 30, {"low", "high"}));
    ASSERT_TRUE(names.has_value());
    EXPECT_EQ(*names, (Names{"low", "high"}));
    EXPECT_NEAR(volume(piece, "low"), 3000, 1e-9);
    EXPECT_NEAR(volume(piece, "high"), 7000, 1e-9);
    EXPECT_EQ(piece.name_of(piece.region("high")), "high");
}

TEST(Workpiece, WithoutNamesTheFirstPieceKeepsThatOfTheRegion) {
    Workpiece piece = bar();
    EXPECT_EQ(*piece.carry_out(cut("r0", 30)), (Names{"r0", "r0.2"}));
    EXPECT_EQ(*piece.carry_out(cut("r0", 10)), (Names{"r0", "r0.3"}));
}

TEST(Workpiece, MergesUnitePiecesThatHangTogetherThoughNotAllTouchTheFirst) {
    Workpiece piece = bar();
    ASSERT_TRUE(piece.carry_out(cut("r0", 30, {"a", "bc"})));
    ASSERT_TRUE(piece.carry_out(cut("bc", 60, {"b", "c"})));
    ASSERT_TRUE(piece.carry_out(merge("a", {"c", "b"})));
    EXPECT_NEAR(volume(piece, "a"), 10000, 1e-9);
    EXPECT_TRUE(piece.complex().volumes_sum_exactly());
}

TEST(Workpiece, WhatCannotBeDoneIsRefusedAtThePlaceOfTheStepAndChangesNothing) {
    Workpiece piece = bar();
    ASSERT_TRUE(piece.carry_out(cut("r0", 30, {"left", "rest"})));
    ASSERT_TRUE(piece.carry_out(cut("rest", 60, {"middle", "right"})));

    struct Case {
        Step step;
        std::string code, hint;
    };

    for (const Case& one :
         {Case{cut("midle", 50), "plan.no_such_region", "did you mean 'middle'?"},
          Case{cut("rest", 50), "plan.no_such_region", "it was cut into middle, right"},
          Case{merge("left", {"x"}), "plan.no_such_region",
               "at this step there are left, middle, right"},
          Case{cut("left", 50), "plan.cut_misses", "move the plane, or leave the cut out"},
          Case{cut("left", 20, {"left", "right"}), "plan.name_taken",
               "choose another name, and use it in the steps below"},
          Case{merge("left", {"right"}), "plan.not_neighbours",
               "only parts with a common face can be merged"}}) {
        const auto done = piece.carry_out(one.step);
        ASSERT_FALSE(done.has_value()) << one.code;
        EXPECT_EQ(done.error().code, one.code);
        EXPECT_EQ(done.error().hint, one.hint);
        EXPECT_EQ(done.error().where, "plan.toml:9:1");
        EXPECT_NEAR(volume(piece, "left"), 3000, 1e-9);
    }
}

TEST(Workpiece, APlanOfAnotherShapeIsRefused) {
    const auto shape = tests::box({0, 0, 0}, {100, 10, 10});
    Plan plan;
    plan.shape_sha256 = decomp::plan::shape_sha256(shape);
    plan.steps = {cut("r0", 30)};
    EXPECT_TRUE(Workpiece::carried_out(shape, plan).has_value());
    const auto other = Workpiece::carried_out(tests::box({0, 0, 0}, {100, 10, 10.5}), plan);
    ASSERT_FALSE(other.has_value());
    EXPECT_EQ(other.error().code, "plan.other_shape");
}

TEST(Workpiece, WhatACutGaveIsFoundAgainAlongTheSameLoops) {
    // Half a ring has two arms: one of them is cut off, then the other.
    const auto ring = tests::torus(50, 10, 24, 12);
    auto complex = *decomp::cut::Complex::from_volume(ring);
    ASSERT_TRUE(complex.split(0, {kX, 0.5}).has_value());
    for (const double x : {-10.0, -12.0}) {
        ASSERT_EQ(complex.section(0, {kX, x})->size(), 2U);
        ASSERT_EQ(complex.split(0, {kX, x}, std::vector<std::int32_t>{1})->size(), 2U);
    }
    Plan plan;
    plan.shape_sha256 = decomp::plan::shape_sha256(ring);
    plan.steps =
        decomp::plan::steps_of(complex, std::vector<std::string>(complex.steps().size(), "a test"));
    ASSERT_EQ(plan.steps.size(), 3U);
    EXPECT_EQ(plan.steps[1].loops_mm.size(), 1U);
    const auto again = Workpiece::carried_out(ring, plan);
    ASSERT_TRUE(again.has_value()) << again.error().text();
    ASSERT_EQ(again->complex().region_count(), complex.region_count());
    for (std::int32_t region = 0; region < complex.region_count(); ++region) {
        EXPECT_EQ(again->complex().region(region).mesh.points, complex.region(region).mesh.points);
        EXPECT_EQ(again->complex().region(region).mesh.triangles,
                  complex.region(region).mesh.triangles);
    }
}

}  // namespace
