// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/plan_part.h"

#include "tests/support/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace {

using cam::fdm::plan_part;
using cam::path::Bead;
using cam::path::Feature;
using cam::path::LayerStack;

double volume_mm3(const Bead& bead) {
    double length = 0;
    for (std::size_t i = 0; i + 1 < bead.points.size(); ++i) {
        length += (bead.points[i + 1] - bead.points[i]).norm();
    }
    return length * cam::path::bead_area_mm2(bead.width_mm, bead.height_mm);
}

double volume_mm3(const cam::path::Layer& layer) {
    double sum = 0;
    for (const Bead& bead : layer.beads) {
        sum += volume_mm3(bead);
    }
    return sum;
}

std::map<Feature, int> count_features(const cam::path::Layer& layer) {
    std::map<Feature, int> out;
    for (const Bead& bead : layer.beads) {
        ++out[bead.feature];
    }
    return out;
}

cam::profile::FdmSetup setup() { return {}; }

TEST(PlanPart, ACubeGetsTheFirstLayerHeightThenEqualLayers) {
    const auto stack = plan_part(tests::box({-5, -5, 0}, {5, 5, 3.05}), setup(), {});
    ASSERT_TRUE(stack);
    ASSERT_EQ(stack->layers.size(), 15U);
    EXPECT_DOUBLE_EQ(stack->layers[0].z_mm, 0.25);
    EXPECT_NEAR(stack->layers[14].z_mm, 3.05, 1e-12);
    EXPECT_DOUBLE_EQ(stack->layers[3].height_mm, 0.2);
}

TEST(PlanPart, SolidLayersHoldAsMuchPlasticAsTheyHaveRoom) {
    const auto stack = plan_part(tests::box({-15, -10, 0}, {15, 10, 4}), setup(), {});
    ASSERT_TRUE(stack);
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& layer = stack->layers[i];
        EXPECT_NEAR(volume_mm3(layer) / (600 * layer.height_mm), 1, 0.01) << i;
    }
}

TEST(PlanPart, FullInfillHasTheVolumeOfTheMesh) {
    auto full = setup();
    full.machine.process.infill_density = 1;
    const auto stack = plan_part(tests::box({-10, -10, 0}, {10, 10, 10.05}), full, {});
    ASSERT_TRUE(stack);
    double volume = 0;
    for (const auto& layer : stack->layers) {
        for (const auto& bead : layer.beads) {
            const bool support =
                bead.feature == Feature::Support || bead.feature == Feature::SupportInterface;
            volume += support ? 0 : volume_mm3(bead);
        }
    }
    EXPECT_NEAR(volume / 4020, 1, 0.01);
}

TEST(PlanPart, AWallThinnerThanTwoBeadsIsOneBeadOfItsWidth) {
    for (const double width : {0.3, 0.45, 0.6}) {
        const auto stack = plan_part(tests::box({-10, 0, 0}, {10, width, 2}), setup(), {});
        ASSERT_TRUE(stack);
        ASSERT_EQ(stack->layers[4].beads.size(), 1U) << width;
        EXPECT_NEAR(stack->layers[4].beads[0].width_mm, width, 1e-3);
        EXPECT_EQ(stack->layers[4].beads[0].feature, Feature::OuterWall);
    }
}

TEST(PlanPart, EveryLayerOfASpireHasABead) {
    auto spire = tests::box({-2, -2, 0}, {2, 2, 10});
    for (auto& p : spire.points) {
        if (p.z() > 5) {
            p.x() *= 0.05;
            p.y() *= 0.05;
        }
    }
    const auto stack = plan_part(spire, setup(), {});
    ASSERT_TRUE(stack);
    for (const auto& layer : stack->layers) {
        EXPECT_FALSE(layer.beads.empty()) << layer.z_mm;
    }
}

TEST(PlanPart, AFinThatStartsThinnerThanABeadIsSupportedWhereItCanBePrinted) {
    // A blade hanging edge down beside a block: its lowest millimetre is too thin to print.
    auto blade = tests::box({10, -5, 4}, {10.6, 5, 10});
    for (auto& p : blade.points) {
        if (p.z() < 5) {
            p.x() = 10.3 + (p.x() - 10.3) * 0.02;
        }
    }
    const auto part = tests::joined(tests::box({-5, -5, 0}, {5, 5, 12}),
                                    tests::joined(blade, tests::box({0, -5, 9.9}, {12, 5, 12})));
    const auto stack = plan_part(part, setup(), {});
    ASSERT_TRUE(stack);
    std::size_t first = 0;
    const auto on_blade = [](const Bead& bead) {
        const bool wall =
            bead.feature == Feature::OuterWall || bead.feature == Feature::OverhangWall;
        return wall && bead.points.front().x() > 9 && bead.width_mm < 0.3;
    };
    const auto has_blade = [&](const cam::path::Layer& layer) {
        return std::any_of(layer.beads.begin(), layer.beads.end(), on_blade);
    };
    while (first < stack->layers.size() && !has_blade(stack->layers[first])) {
        ++first;
    }
    ASSERT_GT(first, 20U);
    ASSERT_LT(first, 45U);
    auto below = count_features(stack->layers[first - 2]);
    EXPECT_GT(below[Feature::SupportInterface], 0);
}

TEST(PlanPart, TopAndBottomAreSolidAndTheMiddleIsSparse) {
    const auto stack = plan_part(tests::box({-15, -15, 0}, {15, 15, 6.05}), setup(), {});
    ASSERT_TRUE(stack);
    auto bottom = count_features(stack->layers[0]);
    EXPECT_GT(bottom[Feature::BottomSkin], 0);
    auto middle = count_features(stack->layers[15]);
    EXPECT_GT(middle[Feature::SparseInfill], 0);
    EXPECT_EQ(middle[Feature::SolidInfill], 0);
    auto top = count_features(stack->layers.back());
    EXPECT_GT(top[Feature::TopSkin], 0);
    EXPECT_EQ(top[Feature::SparseInfill], 0);
    auto under_top = count_features(stack->layers[stack->layers.size() - 4]);
    EXPECT_GT(under_top[Feature::SolidInfill], 0);
    auto over_infill = count_features(stack->layers[stack->layers.size() - 5]);
    EXPECT_GT(over_infill[Feature::Bridge], 0)
        << "the first skin hangs from line to line of infill";
    EXPECT_EQ(under_top[Feature::Bridge], 0);
}

/// A box and which of its triangles lie at x = 15.
struct MatingBox {
    tests::TriMesh mesh = tests::box({-15, -15, 0}, {15, 15, 6.05});
    std::vector<bool> mating;

    MatingBox() {
        for (const auto& t : mesh.triangles) {
            mating.push_back(
                std::all_of(t.begin(), t.end(), [&](auto v) { return mesh.points[v].x() == 15; }));
        }
    }
};

TEST(PlanPart, AFaceThatTouchesAnotherPartGivesWayAndTakesTheSeams) {
    const MatingBox part;
    auto gap = setup();
    gap.machine.process.mating_gap_mm = 0.3;
    const auto stack = plan_part(part.mesh, part.mating, gap, {});
    ASSERT_TRUE(stack);
    for (std::size_t i = 1; i < stack->layers.size(); ++i) {
        for (const Bead& bead : stack->layers[i].beads) {
            if (bead.feature == Feature::OuterWall) {
                EXPECT_NEAR(bead.points.front().x(), 15 - 0.15 - 0.225, 1e-3) << i;
                EXPECT_LT(std::abs(bead.points.front().y()), 14) << "not at the edge";
                double low = 0;
                for (const auto& p : bead.points) {
                    low = std::min(low, p.x());
                }
                EXPECT_NEAR(low, -15 + 0.225, 1e-3) << "the other side keeps its place";
            }
        }
    }
}

TEST(PlanPart, InfillBehindAnInterfaceIsDenser) {
    const MatingBox part;
    auto denser = setup();
    denser.machine.process.interface_infill_density = 0.6;
    denser.machine.process.interface_infill_mm = 5;
    const auto sparse_near = [&](const std::vector<bool>& mating, bool near) {
        const auto stack = plan_part(part.mesh, mating, denser, {});
        double sum = 0;
        for (const Bead& bead : stack->layers[15].beads) {
            for (std::size_t i = 0; i + 1 < bead.points.size(); ++i) {
                const bool here = (bead.points[i] + bead.points[i + 1]).x() / 2 > 7;
                const bool counts = bead.feature == Feature::SparseInfill && here == near;
                sum += counts ? (bead.points[i + 1] - bead.points[i]).norm() : 0;
            }
        }
        return sum;
    };
    EXPECT_GT(sparse_near(part.mating, true), 2 * sparse_near({}, true));
}

TEST(PlanPart, APortalIsBridgedAcrossItsOpening) {
    // Two pillars and a lintel that shares faces with neither: the lintel lies on them.
    const auto portal = tests::joined(tests::joined(tests::box({-20, -10, 0}, {-10, 10, 10.05}),
                                                    tests::box({10, -10, 0}, {20, 10, 10.05})),
                                      tests::box({-20, -10, 10.0}, {20, 10, 14}));
    const auto stack = plan_part(portal, setup(), {});
    ASSERT_TRUE(stack);
    const auto& first_over_air = stack->layers[50];
    bool found = false;
    for (const Bead& bead : first_over_air.beads) {
        if (bead.feature == Feature::Bridge) {
            found = true;
            const Eigen::Vector2d along = bead.points[1] - bead.points[0];
            EXPECT_GT(std::abs(along.x()), 10 * std::abs(along.y()));
        }
    }
    EXPECT_TRUE(found);
}

TEST(PlanPart, TheBrimComesFirstFromOutsideInAndTouchesThePart) {
    auto brimmed = setup();
    brimmed.machine.process.brim_width_mm = 3;
    const auto stack = plan_part(tests::box({-5, -5, 0}, {5, 5, 2}), brimmed, {});
    ASSERT_TRUE(stack);
    const auto& beads = stack->layers[0].beads;
    double last = 100;
    std::size_t loops = 0;
    for (; beads.at(loops).feature == Feature::Brim; ++loops) {
        double reach = 0;
        for (const auto& p : beads[loops].points) {
            reach = std::max(reach, p.x());
        }
        EXPECT_LT(reach, last);
        last = reach;
    }
    EXPECT_EQ(loops, 6U);
    const double foot = 5 - brimmed.machine.process.elephant_foot_mm;
    EXPECT_NEAR(last, foot + 0.25, 1e-3);
    for (const auto& bead : stack->layers[1].beads) {
        EXPECT_NE(bead.feature, Feature::Brim);
    }
}

TEST(PlanPart, BeadsStayInsideThePart) {
    const auto stack = plan_part(tests::box({-10, -10, 0}, {10, 10, 5}), setup(), {});
    ASSERT_TRUE(stack);
    for (const auto& layer : stack->layers) {
        for (const auto& bead : layer.beads) {
            for (const auto& p : bead.points) {
                EXPECT_LE(p.cwiseAbs().maxCoeff() + bead.width_mm / 2, 10 + 1e-5);
            }
        }
    }
}

TEST(PlanPart, ThreadsDoNotChangeTheResult) {
    const auto ball = tests::torus(10, 4, 48, 24);
    auto raised = ball;
    for (auto& p : raised.points) {
        p.z() += 4;
    }
    decomp::Run two;
    two.jobs = 2;
    const auto a = plan_part(raised, setup(), {});
    const auto b = plan_part(raised, setup(), two);
    ASSERT_TRUE(a);
    ASSERT_TRUE(b);
    ASSERT_EQ(a->layers.size(), b->layers.size());
    for (std::size_t i = 0; i < a->layers.size(); ++i) {
        ASSERT_EQ(a->layers[i].beads.size(), b->layers[i].beads.size());
        for (std::size_t k = 0; k < a->layers[i].beads.size(); ++k) {
            EXPECT_EQ(a->layers[i].beads[k].points, b->layers[i].beads[k].points);
        }
    }
}

TEST(PlanPart, AMeshWithoutHeightIsAnError) {
    const auto stack = plan_part(tests::box({0, 0, 0}, {5, 5, 0.05}), setup(), {});
    ASSERT_FALSE(stack);
    EXPECT_EQ(stack.error().code, "fdm.empty");
}

TEST(PlanPart, ACancelledRunSaysSo) {
    std::stop_source source;
    source.request_stop();
    decomp::Run run;
    run.stop = source.get_token();
    const auto stack = plan_part(tests::box({0, 0, 0}, {5, 5, 5}), setup(), run);
    ASSERT_FALSE(stack);
    EXPECT_EQ(stack.error().code, "run.cancelled");
}

}  // namespace
