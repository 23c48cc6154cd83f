// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/judges.h"

#include "decomp/mesh/measure.h"
#include "tests/support/part_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using cam::check::mill3_judge;
using cam::check::mill4_judge;
using cam::check::Setups;
using cam::profile::MillSetup;
using decomp::part::Fidelity;
using decomp::part::Verdict;
using tests::whole;

MillSetup router() {
    MillSetup setup =
        cam::profile::read_mill_setup("linuxcnc-router-4axis", {"flat-6", "ball-3"}).value();
    setup.machine.reach.cell_mm = 0.25;
    setup.machine.reach.tolerance_mm = 0.25;
    setup.machine.reach.angles = 12;
    return setup;
}

bool names(const Verdict& verdict, const std::string& constraint) {
    return std::any_of(verdict.violations.begin(), verdict.violations.end(),
                       [&](const auto& v) { return v.constraint == constraint; });
}

TEST(MillJudges, AHalfSphereIsFineOnThreeAxesAndASphereIsNot) {
    const auto judge = mill3_judge(router(), Setups::One);
    for (const Fidelity fidelity : {Fidelity::Estimate, Fidelity::Exact}) {
        const Verdict half = judge(whole(tests::half_sphere(15, 48, 24)), fidelity);
        EXPECT_TRUE(half.ok()) << half.violations.front().constraint;
        const Verdict ball = judge(whole(tests::sphere(15, 48, 25)), fidelity);
        EXPECT_TRUE(names(ball, "reach"));
        EXPECT_TRUE(names(ball, "base"));
        ASSERT_FALSE(ball.cuts_that_help.empty());
        // The undercut is the lower half: the first cut is near the equator, across the spindle.
        EXPECT_NEAR(ball.cuts_that_help[0].offset_mm, 0, 3);
    }
    EXPECT_TRUE(
        mill3_judge(router(), Setups::Two)(whole(tests::sphere(15, 48, 25)), Fidelity::Estimate)
            .ok());
}

TEST(MillJudges, TheJudgedPoseLiesOnTheTable) {
    const auto part = whole(tests::half_sphere(15, 48, 24));
    const Verdict verdict = mill3_judge(router(), Setups::One)(part, Fidelity::Exact);
    const auto box = decomp::mesh::bounds(
        decomp::mesh::transformed(part.mesh, Eigen::Affine3d(verdict.best_pose.map().matrix())));
    EXPECT_NEAR(box.min().z(), 0, 1e-9);
    EXPECT_NEAR(box.max().z(), 15, 1e-6);
    EXPECT_NEAR(box.center().x(), 0, 1e-9);
}

TEST(MillJudges, ATorusIsFineAboutARotaryAxisAndABottleIsNot) {
    const auto judge = mill4_judge(router());
    for (const Fidelity fidelity : {Fidelity::Estimate, Fidelity::Exact}) {
        EXPECT_FALSE(names(judge(whole(tests::torus(20, 6, 48, 24)), fidelity), "reach"));
        const auto bottle =
            tests::revolved(5, {{8, 5}, {8, 20}, {2, 22}, {2, 30}, {12, 30}, {12, 0}}, 0, 48);
        const Verdict verdict = judge(whole(bottle), fidelity);
        EXPECT_TRUE(names(verdict, "reach"));
        EXPECT_FALSE(verdict.cuts_that_help.empty());
    }
}

TEST(MillJudges, WhatIsTooLargeIsSaidByRatio) {
    const auto setup = router();
    const auto flat = cam::check::mill_misfits(setup.machine, setup.tools, {700, 100, 20});
    ASSERT_EQ(flat.size(), 1U);
    EXPECT_EQ(flat[0].constraint, "travel.x");
    EXPECT_NEAR(flat[0].by_ratio, 706.0 / 596, 1e-9);
    EXPECT_TRUE(cam::check::mill_misfits(setup.machine, setup.tools, {590, 100, 20}).empty());
    // 35 of stickout and 109 of part do not go under 138.
    const auto high = cam::check::mill_misfits(setup.machine, setup.tools, {10, 10, 109});
    EXPECT_EQ(high.size(), 2U);
    const auto thick = cam::check::rotary_misfits(setup.machine, setup.tools, 61, 100);
    ASSERT_EQ(thick.size(), 2U);
    EXPECT_EQ(thick[0].constraint, "rotary.diameter");
    EXPECT_EQ(thick[1].constraint, "spindle");
    cam::profile::MillMachine three;
    EXPECT_EQ(cam::check::rotary_misfits(three, setup.tools, 1, 1)[0].constraint, "rotary");
}

TEST(PrintingJudge, WantsLittleSupportToo) {
    cam::profile::FdmSetup setup;
    setup.machine.chamber.min_mm = {-100, -100, 0};
    setup.machine.chamber.max_mm = {100, 100, 200};
    const auto ball = whole(tests::sphere(20, 96, 95));
    EXPECT_TRUE(cam::check::support_judge(setup, 20)(ball, Fidelity::Exact).ok());
    const Verdict strict = cam::check::support_judge(setup, 5)(ball, Fidelity::Exact);
    EXPECT_TRUE(names(strict, "support"));
    EXPECT_NEAR(strict.violations.back().by_ratio, 14.6 / 5, 0.1);
}

}  // namespace
