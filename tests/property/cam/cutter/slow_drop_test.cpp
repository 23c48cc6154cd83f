// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/slow_drop.h"

#include "cam/cutter/drop_cutter.h"
#include "decomp/base/rng.h"
#include "tests/support/cutters.h"

#include <gtest/gtest.h>

namespace {

constexpr int kPoints = 10000;
constexpr double kFloor = -9;

class EveryShape : public testing::TestWithParam<std::size_t> {};

TEST_P(EveryShape, DropsLikeASearchOverAllTriangles) {
    const cam::tool::Tool tool = tests::one_of_each().at(GetParam());
    const decomp::mesh::TriMesh mesh = tests::dented_ball_and_block();
    const cam::cutter::Surface surface(mesh);
    const cam::cutter::DropCutter cutter(surface, cam::tool::outline_of(tool));
    decomp::Rng rng(7);
    double worst = 0;
    Eigen::Vector2d where(0, 0);
    for (int i = 0; i < kPoints; ++i) {
        const Eigen::Vector2d at(-28 + 62 * rng.uniform(), -17 + 34 * rng.uniform());
        const double off =
            std::abs(cutter.lowest_tip(at, kFloor) - tests::slow_drop(mesh, tool, at, kFloor));
        if (off > worst) {
            worst = off;
            where = at;
        }
    }
    EXPECT_LT(worst, 1e-6) << tool.name << " at " << where.transpose();
    RecordProperty("worst_mm", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(DropCutter, EveryShape, testing::Range<std::size_t>(0, 6));

}  // namespace
