// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/plan.h"
#include "cam/mill/setup.h"
#include "decomp/base/rng.h"
#include "tests/support/milling.h"
#include "tests/support/shapes.h"
#include "tests/support/slow_drop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <variant>
#include <vector>

namespace {

using cam::mill::MillTask;
using cam::mill::plan_milling;
using cam::mill::Setups;
using cam::path::MillCut;
using cam::path::MillOperation;
using cam::path::MillPlan;
using cam::path::MillProgram;
using cam::path::MillRapid;
using cam::path::MillSpindle;
using cam::path::MillTakeTool;
using decomp::part::Part;
using Eigen::Vector3d;

const Part& dome() {
    static const Part part = tests::whole_part(tests::domed_plate());
    return part;
}

const MillPlan& dome_plan() {
    static const MillPlan plan = [] {
        MillTask task = tests::soft_task(6);
        task.scallop_mm = 0.05;
        task.cell_mm = 0.4;
        decomp::Run run;
        auto made = plan_milling(dome(), task, run);
        EXPECT_TRUE(made) << made.error().message;
        return made ? *made : MillPlan{};
    }();
    return plan;
}

/// Every straight move with where it comes from.
struct Piece {
    Vector3d from;
    Vector3d to;
    bool rapid = false;
    int tool = 0;
    double rpm = 0;
    MillOperation operation{};
};

std::vector<Piece> pieces_of(const MillProgram& program) {
    std::vector<Piece> out;
    Vector3d at(0, 0, program.safe_z);
    int tool = 0;
    double rpm = 0;
    for (const auto& move : program.moves) {
        if (const auto* take = std::get_if<MillTakeTool>(&move.what)) {
            tool = take->number;
        } else if (const auto* spindle = std::get_if<MillSpindle>(&move.what)) {
            rpm = spindle->rpm;
        } else if (const auto* rapid = std::get_if<MillRapid>(&move.what)) {
            out.push_back({at, rapid->to, true, tool, rpm, move.operation});
            at = rapid->to;
        } else if (const auto* cut = std::get_if<MillCut>(&move.what)) {
            out.push_back({at, cut->to, false, tool, rpm, move.operation});
            at = cut->to;
        }
    }
    return out;
}

TEST(MillPlan, APartWithAFlatBackIsMilledFromOneSide) {
    ASSERT_EQ(dome_plan().programs.size(), 1U);
    const MillProgram& program = dome_plan().programs[0];
    EXPECT_EQ(program.hold, cam::path::Hold::Bottom);
    EXPECT_TRUE(program.from_model.turn(Vector3d::UnitZ()).isApprox(Vector3d::UnitZ()));
    EXPECT_TRUE(program.stock.min().head<2>().isZero());
    EXPECT_EQ(program.stock.max().z(), 0);
    EXPECT_NEAR((program.from_model * Vector3d(0, 0, 0)).z(), program.stock.min().z(), 1e-9);
}

TEST(MillPlan, NoPointOfAPathCutsIntoThePart) {
    const MillProgram& program = dome_plan().programs[0];
    decomp::mesh::TriMesh part = dome().mesh;
    for (Vector3d& p : part.points) {
        p = program.from_model * p;
    }
    std::map<int, cam::tool::Tool> tools;
    for (const auto& tool : dome_plan().tools) {
        tools[tool.number] = tool;
    }
    const auto pieces = pieces_of(program);
    ASSERT_GT(pieces.size(), 1000U);
    decomp::Rng rng(5);
    for (int i = 0; i < 150; ++i) {
        const Piece& piece = pieces[rng.below(pieces.size())];
        const Vector3d at = piece.from + rng.uniform() * (piece.to - piece.from);
        if (piece.tool == 0) {
            continue;
        }
        // A point beside the part by the tolerance is no gouge: try the four sides.
        double tip = 1e9;
        for (const Eigen::Vector2d& by :
             {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.012, 0), Eigen::Vector2d(-0.012, 0),
              Eigen::Vector2d(0, 0.012), Eigen::Vector2d(0, -0.012)}) {
            tip = std::min(tip, tests::slow_drop(part, tools.at(piece.tool), at.head<2>() + by,
                                                 program.stock.min().z()));
        }
        EXPECT_GT(at.z(), tip - 0.012)
            << "operation " << operation_name(piece.operation) << " at " << at.transpose();
    }
}

TEST(MillPlan, RapidsGoAcrossOnlyAtTheSafeHeight) {
    for (const Piece& piece : pieces_of(dome_plan().programs[0])) {
        if (piece.rapid && (piece.from - piece.to).head<2>().norm() > 1e-9) {
            EXPECT_EQ(piece.from.z(), dome_plan().programs[0].safe_z);
            EXPECT_EQ(piece.to.z(), dome_plan().programs[0].safe_z);
        }
    }
}

TEST(MillPlan, NothingIsCutBeforeAToolTurns) {
    const MillProgram& program = dome_plan().programs[0];
    for (const Piece& piece : pieces_of(program)) {
        EXPECT_NE(piece.tool, 0);
        EXPECT_GT(piece.rpm, 0);
    }
    ASSERT_FALSE(program.moves.empty());
    EXPECT_TRUE(std::holds_alternative<MillTakeTool>(program.moves.front().what));
    const auto* last = std::get_if<MillSpindle>(&program.moves.back().what);
    ASSERT_NE(last, nullptr);
    EXPECT_EQ(last->rpm, 0);
}

TEST(MillPlan, NoTipGoesBelowTheFloor) {
    for (const Piece& piece : pieces_of(dome_plan().programs[0])) {
        EXPECT_GE(piece.to.z(), dome_plan().programs[0].floor_z - 1e-9);
    }
}

TEST(MillPlan, FinishingLeavesNoMoreThanScallopsOnTheDome) {
    // Stamps the finishing moves over points of the dome.
    const MillProgram& program = dome_plan().programs[0];
    std::vector<Vector3d> points;
    for (int i = 0; i < 200; ++i) {
        const double turn = 0.31 * i;
        const double r = 13.0 * i / 200;
        // On the profile's chords: between (4, 15.5), (9, 14), (14, 10.5).
        const double z = r < 4 ? 16 - r / 8 : (r < 9 ? 15.5 - (r - 4) * 0.3 : 14 - (r - 9) * 0.7);
        points.push_back(program.from_model * Vector3d(r * std::cos(turn), r * std::sin(turn), z));
    }
    std::vector<double> left(points.size(), 100);
    for (const Piece& piece : pieces_of(program)) {
        if (piece.tool != 2 || piece.rapid) {
            continue;
        }
        const int steps = 1 + static_cast<int>((piece.to - piece.from).norm() / 0.05);
        for (int s = 0; s <= steps; ++s) {
            const Vector3d at = piece.from + (piece.to - piece.from) * s / steps;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const double r = (points[i] - at).head<2>().norm();
                if (r < 3) {
                    left[i] = std::min(left[i], at.z() + 3 - std::sqrt(9 - r * r) - points[i].z());
                }
            }
        }
    }
    EXPECT_LT(*std::max_element(left.begin(), left.end()), 0.12);
}

TEST(MillPlan, FinishingReachesTheFootOfAWallWhereverTheLinesRun) {
    const Part dish = tests::whole_part(tests::dished_plate());
    for (const double direction : {0.0, 25.0}) {
        MillTask task = tests::soft_task(3);
        task.setups = Setups::One;
        task.scallop_mm = 0.1;
        task.lines = decomp::Angle::degrees(direction);
        decomp::Run run;
        const auto plan = plan_milling(dish, task, run);
        ASSERT_TRUE(plan) << plan.error().message;
        const MillProgram& program = plan->programs[0];
        // Where a ball of 3 mm in the corner of floor and wall touches the floor, all around.
        const double apothem = 8 * std::cos(std::numbers::pi / 72);
        const double rise = 1 / std::hypot(6, 1);
        const double r = apothem - 1.5 * (1 - rise) / (6 * rise);
        std::vector<Vector3d> points;
        for (int i = 0; i < 60; ++i) {
            const double turn = 2 * std::numbers::pi * i / 60;
            points.push_back(program.from_model *
                             Vector3d(r * std::cos(turn), r * std::sin(turn), 4));
        }
        std::vector<double> left(points.size(), 100);
        for (const Piece& piece : pieces_of(program)) {
            const int steps = 1 + static_cast<int>((piece.to - piece.from).norm() / 0.05);
            for (int s = 0; piece.tool == 2 && !piece.rapid && s <= steps; ++s) {
                const Vector3d at = piece.from + (piece.to - piece.from) * s / steps;
                for (std::size_t i = 0; i < points.size(); ++i) {
                    const double away = std::min(1.5, (points[i] - at).head<2>().norm());
                    const double z =
                        away < 1.5 ? at.z() + 1.5 - std::sqrt(2.25 - away * away) : 100;
                    left[i] = std::min(left[i], z - points[i].z());
                }
            }
        }
        EXPECT_LT(*std::max_element(left.begin(), left.end()), 0.1 + 0.01) << direction;
        EXPECT_GT(*std::min_element(left.begin(), left.end()), -0.005) << direction;
    }
}

TEST(MillPlan, AFlatToolTakesTheFilletThatTheRoundOneLeavesAtTheFootOfAWall) {
    // A round pocket with an upright wall: a ball of 6 mm leaves 3 mm of fillet around its floor.
    const Part dish =
        tests::whole_part(tests::revolved(4, {{8, 4}, {8, 10}, {14, 10}, {14, 0}}, 0, 72));
    MillTask task = tests::soft_task(6);
    task.setups = Setups::One;
    task.scallop_mm = 0.1;
    decomp::Run run;
    const auto plan = plan_milling(dish, task, run);
    ASSERT_TRUE(plan) << plan.error().message;
    const MillProgram& program = plan->programs[0];
    const double apothem = 8 * std::cos(std::numbers::pi / 72);
    std::vector<Vector3d> feet;
    std::vector<Vector3d> walls;
    for (int i = 0; i < 60; ++i) {
        const double turn = 2 * std::numbers::pi * i / 60;
        const Vector3d out(std::cos(turn), std::sin(turn), 0);
        feet.push_back(program.from_model * Vector3d((apothem - 0.04) * out + Vector3d(0, 0, 4)));
        walls.push_back(program.from_model * Vector3d(8.01 * out + Vector3d(0, 0, 7)));
    }
    std::vector<double> left(feet.size(), 100);
    for (const Piece& piece : pieces_of(program)) {
        const int steps = 1 + static_cast<int>((piece.to - piece.from).norm() / 0.05);
        for (int s = 0; piece.tool == 1 && !piece.rapid && s <= steps; ++s) {
            const Vector3d at = piece.from + (piece.to - piece.from) * s / steps;
            for (std::size_t i = 0; i < feet.size(); ++i) {
                if ((feet[i] - at).head<2>().norm() < 3) {
                    left[i] = std::min(left[i], at.z() - feet[i].z());
                }
                EXPECT_FALSE((walls[i] - at).head<2>().norm() < 3 && at.z() < walls[i].z())
                    << at.transpose();
            }
        }
    }
    for (std::size_t i = 0; i < feet.size(); ++i) {
        EXPECT_LT(left[i], 0.02) << feet[i].transpose();
        EXPECT_GT(left[i], -0.005) << feet[i].transpose();
    }
}

TEST(MillPlan, TheSamePlanComesOutAtAnyNumberOfThreads) {
    MillTask task = tests::soft_task(6);
    task.scallop_mm = 0.1;
    task.cell_mm = 0.5;
    decomp::Run one;
    decomp::Run three;
    three.jobs = 3;
    const auto a = plan_milling(dome(), task, one);
    const auto b = plan_milling(dome(), task, three);
    ASSERT_TRUE(a && b);
    const auto pieces = pieces_of(a->programs[0]);
    const auto others = pieces_of(b->programs[0]);
    ASSERT_EQ(pieces.size(), others.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        EXPECT_EQ(pieces[i].to, others[i].to);
    }
}

TEST(MillPlan, ToolsThatCannotRoughAreRefused) {
    MillTask task = tests::soft_task(6);
    for (auto& cutter : task.cutters) {
        cutter.feeds.rough.feed = {};
    }
    decomp::Run run;
    const auto plan = plan_milling(dome(), task, run);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, "mill.no_cutter");
}

TEST(Clamping, ABlockThatIsTooSmallIsRefusedWithTheSizeThatIsNeeded) {
    MillTask task = tests::soft_task(6);
    task.stock_mm = Vector3d(40, 40, 10);
    decomp::Run run;
    const auto clamping = clamp_part(dome(), task, run);
    ASSERT_FALSE(clamping);
    EXPECT_EQ(clamping.error().code, "mill.stock_too_small");
}

TEST(Clamping, ABallNeedsTwoSidesTabsAndDowels) {
    const Part ball = tests::whole_part(tests::sphere(15, 48, 24));
    const MillTask task = tests::soft_task(6);
    decomp::Run run;
    const auto clamping = clamp_part(ball, task, run);
    ASSERT_TRUE(clamping) << clamping.error().message;
    ASSERT_EQ(clamping->benches.size(), 2U);
    EXPECT_EQ(clamping->dowels.size(), 2U);
    const auto tabs =
        std::count_if(clamping->keeps.begin(), clamping->keeps.end(),
                      [](const auto& keep) { return keep.kind == cam::path::MillKeep::Kind::Tab; });
    EXPECT_EQ(tabs, 4);
    // The turn carries stock onto stock and dowels onto dowels.
    const auto& top = clamping->benches[0].program;
    const auto& bottom = clamping->benches[1].program;
    const Eigen::Isometry3d over = bottom.from_model.map() * top.from_model.map().inverse();
    EXPECT_TRUE(
        (over * top.stock.min()).cwiseMin(over * top.stock.max()).isApprox(bottom.stock.min()));
    for (const auto& dowel : clamping->dowels) {
        const Vector3d there = over * Vector3d(dowel.at.x(), dowel.at.y(), 0);
        EXPECT_NEAR((there.head<2>() - dowel.at).norm(), 0, 1e-9);
    }
    // Both sides together leave no ring of stock between them.
    const double second_floor = (over.inverse() * Vector3d(0, 0, clamping->benches[1].floor_z)).z();
    EXPECT_LT(clamping->benches[0].floor_z, second_floor);
}

TEST(Clamping, TabsKeepOffCutFaces) {
    Part block = tests::whole_part(tests::sphere(15, 48, 24));
    // What lies beyond x = 10 counts as cut.
    for (std::size_t t = 0; t < block.mesh.triangles.size(); ++t) {
        for (const auto v : block.mesh.triangles[t]) {
            if (block.mesh.points[v].x() > 10) {
                block.sources[t].plane = 0;
            }
        }
    }
    MillTask task = tests::soft_task(6);
    task.setups = Setups::Two;
    decomp::Run run;
    const auto clamping = clamp_part(block, task, run);
    ASSERT_TRUE(clamping) << clamping.error().message;
    const auto& pose = clamping->benches[0].program.from_model;
    for (const auto& keep : clamping->keeps) {
        if (keep.kind == cam::path::MillKeep::Kind::Tab) {
            const Vector3d middle = pose.inverse() * keep.box.center();
            EXPECT_LT(middle.x(), 15);
        }
    }
}

}  // namespace
