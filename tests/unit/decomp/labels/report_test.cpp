// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/report.h"

#include "decomp/base/rng.h"
#include "decomp/mesh/check.h"
#include "tests/support/lattice_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace {

using decomp::labels::AxisLabel;
using decomp::labels::report;

TEST(LabelReport, ABoxHasSixChartsTwelveBoundariesEightCorners) {
    const auto box = tests::lattice_solid({{0, 0, 0}}, 3);
    const auto is = report(box.surface, box.labels);
    EXPECT_EQ(is.charts, 6);
    EXPECT_EQ(is.boundaries, 12);
    EXPECT_EQ(is.corners, 8);
    EXPECT_EQ(is.turning_points, 0);
    EXPECT_DOUBLE_EQ(is.fidelity, 1);
    EXPECT_TRUE(is.valid());
}

TEST(LabelReport, AnLHasEightChartsAndTwelveCorners) {
    const auto solid = tests::lattice_solid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 3);
    const auto is = report(solid.surface, solid.labels);
    EXPECT_EQ(is.charts, 8);
    EXPECT_EQ(is.corners, 12);
    EXPECT_EQ(is.boundaries, 18);
    EXPECT_TRUE(is.valid());
}

TEST(LabelReport, ARingOfEightCubesIsValidThoughTwoChartsHaveTwoLoops) {
    const auto ring = tests::lattice_ring(3);
    const auto is = report(ring.surface, ring.labels);
    EXPECT_EQ(is.charts, 10);
    EXPECT_EQ(is.corners, 16);
    EXPECT_TRUE(is.valid());
}

TEST(LabelReport, ANotchInABlockIsValidAndATripodHasABadCornerOfSixBoundaries) {
    const auto notched = tests::lattice_solid(
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, 3);
    EXPECT_TRUE(report(notched.surface, notched.labels).valid());
    const auto tripod = tests::lattice_solid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 3);
    const auto is = report(tripod.surface, tripod.labels);
    EXPECT_EQ(is.bad_corners, 1);
    EXPECT_EQ(is.invalid_charts, 0);
    EXPECT_FALSE(is.valid());
}

TEST(LabelReport, OneLabelForAllIsOneInvalidChart) {
    auto box = tests::lattice_solid({{0, 0, 0}}, 3);
    std::fill(box.labels.begin(), box.labels.end(), AxisLabel::PlusX);
    const auto is = report(box.surface, box.labels);
    EXPECT_EQ(is.charts, 1);
    EXPECT_EQ(is.invalid_charts, 1);
    EXPECT_FALSE(is.valid());
}

TEST(LabelReport, ASideThatRunsOverTheTopMeetsItsOpposite) {
    auto box = tests::lattice_solid({{0, 0, 0}}, 3);
    for (auto& label : box.labels) {
        label = label == AxisLabel::PlusZ ? AxisLabel::MinusX : label;
    }
    const auto is = report(box.surface, box.labels);  // -X now runs over the top and meets +X
    EXPECT_EQ(is.opposite_boundaries, 1);
    EXPECT_FALSE(is.valid());
    EXPECT_LT(is.fidelity, 0.9);
}

TEST(LabelReport, AnIslandInASideIsInvalidAndItsSideToo) {
    auto box = tests::lattice_solid({{0, 0, 0}}, 5);
    for (std::size_t f = 0; f < box.labels.size(); ++f) {
        const auto& t = box.surface.triangles[f];
        const Eigen::Vector3d centre =
            (box.surface.points[t[0]] + box.surface.points[t[1]] + box.surface.points[t[2]]) / 3;
        if (box.labels[f] == AxisLabel::PlusZ &&
            (centre - Eigen::Vector3d(0.5, 0.5, 1)).norm() < 0.25) {
            box.labels[f] = AxisLabel::PlusX;
        }
    }
    const auto is = report(box.surface, box.labels);
    EXPECT_EQ(is.charts, 7);
    EXPECT_EQ(is.invalid_charts, 2);
    EXPECT_EQ(is.corners, 8);
}

TEST(LabelReport, ABoundaryThatTurnsBackHasATurningPoint) {
    auto box = tests::lattice_solid({{0, 0, 0}}, 8);
    for (std::size_t f = 0; f < box.labels.size();
         ++f) {  // a bay of +X in the side +Y, as deep as the hook below
        const auto& t = box.surface.triangles[f];
        const Eigen::Vector3d c =
            (box.surface.points[t[0]] + box.surface.points[t[1]] + box.surface.points[t[2]]) / 3;
        const bool stem = c.x() > 0.5 && c.z() > 0.25 && c.z() < 0.5;
        const bool hook = c.x() > 0.5 && c.x() < 0.75 && c.z() > 0.25 && c.z() < 0.75;
        if (box.labels[f] == AxisLabel::PlusY && (stem || hook)) {
            box.labels[f] = AxisLabel::PlusX;
        }
    }
    const auto is = report(box.surface, box.labels);
    EXPECT_TRUE(is.valid());
    EXPECT_EQ(is.turning_points, 2);
}

TEST(LabelReport, NoRealPolycubeIsCalledImpossible) {
    decomp::Rng rng(7);
    int valid = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<tests::Cube> cubes{{0, 0, 0}};  // grows by neighbours at random
        const auto size = 2 + rng.below(12);
        while (cubes.size() < size) {
            tests::Cube next = cubes[rng.below(cubes.size())];
            next.at(rng.below(3)) += rng.below(2) == 0 ? 1 : -1;
            if (std::find(cubes.begin(), cubes.end(), next) == cubes.end()) {
                cubes.push_back(next);
            }
        }
        const auto solid = tests::lattice_solid(cubes, 2);
        if (!decomp::mesh::check_topology(solid.surface).manifold()) {
            continue;
        }
        const auto is = report(solid.surface, solid.labels);
        valid += is.valid() ? 1 : 0;
        EXPECT_FALSE(is.impossible) << trial;
    }
    EXPECT_GT(valid, 50);
}

TEST(LabelReport, ABoxInsideOutAlongOneAxisIsValidEverywhereAndImpossible) {
    for (const auto& cubes : {std::vector<tests::Cube>{{0, 0, 0}},
                              std::vector<tests::Cube>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}) {
        auto solid = tests::lattice_solid(cubes, 3);
        for (auto& label : solid.labels) {
            label = axis_of(label) == 2 ? opposite(label) : label;
        }
        const auto is = report(solid.surface, solid.labels);
        EXPECT_TRUE(is.valid());
        EXPECT_TRUE(is.impossible);
    }
}

}  // namespace
