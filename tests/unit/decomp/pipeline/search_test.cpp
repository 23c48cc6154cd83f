// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/orient/choose_build.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/pipeline/decompose.h"
#include "decomp/pipeline/nudge.h"
#include "decomp/pipeline/proxy.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <stop_token>

namespace {

using decomp::pipeline::decompose;
using decomp::pipeline::DecomposeOptions;

cam::profile::FdmSetup printer(double x, double y, double z) {
    cam::profile::FdmSetup setup;
    setup.machine.chamber.min_mm = {-x / 2, -y / 2, 0};
    setup.machine.chamber.max_mm = {x / 2, y / 2, z};
    return setup;
}

TEST(Decompose, WhatFitsStaysInOnePiece) {
    decomp::Run run;
    const auto result =
        decompose(tests::sphere(20, 32, 17), {}, cam::orient::fdm_judge(printer(60, 60, 60)), run);
    ASSERT_TRUE(result.has_value()) << result.error().text();
    EXPECT_EQ(result->assembly.parts.size(), 1U);
    EXPECT_EQ(result->cuts, 0);
    EXPECT_EQ(result->tier, "T4");
}

TEST(Decompose, ACancelledRunSaysSo) {
    decomp::Run run;
    std::stop_source source;
    run.stop = source.get_token();
    source.request_stop();
    const auto result = decompose(tests::box({0, 0, 0}, {40, 40, 400}), {},
                                  cam::orient::fdm_judge(printer(60, 60, 60)), run);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, "run.cancelled");
}

TEST(Decompose, AJudgeThatIsNeverContentEndsInAnError) {
    decomp::Run run;
    DecomposeOptions options;
    options.max_parts = 4;
    const decomp::part::Judge never = [](const decomp::part::Part&, decomp::part::Fidelity) {
        decomp::part::Verdict verdict;
        verdict.violations = {{"anything", 2}};
        return verdict;
    };
    const auto result = decompose(tests::box({0, 0, 0}, {10, 10, 10}), options, never, run);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, "decompose.too_many_parts");
}

TEST(Nudge, APlaneThroughVerticesMovesHalfAStepAwayAndNoFurtherThanNeeded) {
    const auto box = tests::box({0, 0, 0}, {1, 1, 1});
    const auto plane = decomp::pipeline::nudged({{0, 0, 1}, 1}, box, 0.01);
    EXPECT_NEAR(plane.offset_mm, 1.01, 1e-12);
    EXPECT_EQ(decomp::pipeline::nudged({{0, 0, 1}, 0.5}, box, 0.01).offset_mm, 0.5);
}

TEST(Proxy, ASimplifiedBallKeepsItsVolumeAndItsTopology) {
    decomp::part::Part ball;
    ball.mesh = tests::sphere(20, 80, 49);
    ball.sources.resize(ball.mesh.triangles.size());
    const auto proxy = decomp::pipeline::simplified(ball, 1500);
    EXPECT_LT(proxy.mesh.triangles.size(), 2000U);
    EXPECT_EQ(proxy.sources.size(), proxy.mesh.triangles.size());
    EXPECT_TRUE(decomp::mesh::check_topology(proxy.mesh).manifold());
    EXPECT_NEAR(decomp::mesh::volume_mm3(proxy.mesh) / decomp::mesh::volume_mm3(ball.mesh), 1,
                1e-2);
}

}  // namespace
