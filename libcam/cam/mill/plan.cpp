// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/plan.h"

#include "cam/mill/finish.h"
#include "cam/mill/maps.h"
#include "cam/mill/rough.h"
#include "cam/mill/work.h"
#include "cam/mill/writer.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace cam::mill {

namespace {

using decomp::Result;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStepOfFinisher = 0.5;  // diameters that a finishing tool may find standing
constexpr double kFootStep = 0.5;        // mm between the levels at the foot of the outline
constexpr double kHelixSlope = 0.05;     // of a dowel hole
constexpr int kHelixCorners = 48;        // chords of a turn: 0.006 mm off at a radius of 3 mm
constexpr double kAboveHolder = 1;       // mm kept between holder and stock over a dowel hole
constexpr double kHeldUpPercent = 0.5;   // of the surface: worth a warning

bool roughs(const Cutter& cutter) { return cutter.feeds.rough.feed.mm_per_s() > 0; }

bool has_round_tip(const Cutter& cutter) {
    return cutter.feeds.finish.feed.mm_per_s() > 0 &&
           (cutter.tool.shape == tool::Shape::Ball || cutter.tool.shape == tool::Shape::BullNose ||
            cutter.tool.shape == tool::Shape::TaperedBall);
}

bool is_flat(const Cutter& cutter) {
    return cutter.tool.shape == tool::Shape::Flat && cutter.feeds.finish.feed.mm_per_s() > 0;
}

/// Which cutter does what.
struct Roles {
    std::vector<const Cutter*> rough;
    std::vector<const Cutter*> finish;
    const Cutter* foot = nullptr;
};

Result<Roles> roles_of(const MillTask& task) {
    Roles roles;
    for (const Cutter& cutter : task.cutters) {
        if (roughs(cutter)) {
            roles.rough.push_back(&cutter);
        }
        if (has_round_tip(cutter)) {
            roles.finish.push_back(&cutter);
        }
        if (is_flat(cutter) && roles.foot == nullptr) {
            roles.foot = &cutter;
        }
    }
    if (roles.finish.empty() && roles.foot != nullptr) {
        roles.finish.push_back(roles.foot);
    }
    if (roles.rough.empty() || roles.finish.empty()) {
        return decomp::fail("mill.no_cutter", "none of the tools can rough, or none can finish", {},
                            "choose tools such as --tools flat-6,ball-3");
    }
    return roles;
}

void bore(Writer& writer, const path::MillProgram& program, const path::MillDowel& dowel,
          const Cutter& cutter) {
    const double radius = (dowel.diameter_mm - cutter.tool.diameter_mm) / 2;
    const double top = program.stock.max().z();
    const auto at = [&](int corner, double z) {
        const double angle = 2 * std::numbers::pi * corner / kHelixCorners;
        return Vector3d(dowel.at.x() + radius * std::cos(angle),
                        dowel.at.y() + radius * std::sin(angle), z);
    };
    writer.approach(at(0, top + 0.5), top + 0.5, cutter.feeds.slot.plunge);
    const double fall = 2 * std::numbers::pi * radius / kHelixCorners * kHelixSlope;
    double z = top + 0.5;
    int corner = 0;
    while (z > dowel.bottom_z) {
        z = std::max(dowel.bottom_z, z - fall);
        writer.cut(at(++corner, z), cutter.feeds.slot.ramp);
    }
    for (int i = 0; i < kHelixCorners; ++i) {
        writer.cut(at(++corner, z), cutter.feeds.slot.ramp);
    }
    writer.cut(Vector3d(dowel.at.x(), dowel.at.y(), z), cutter.feeds.slot.ramp);
    writer.retract();
}

/// Dowel holes go as deep as the tool does, at most through the stock.
void bore_dowels(Writer& writer, const path::MillProgram& program, path::MillPlan& plan,
                 const Cutter& cutter) {
    if (plan.dowels.empty()) {
        return;
    }
    const double top = program.stock.max().z();
    const bool thin_shank = cutter.tool.shank_diameter_mm <= plan.dowels.front().diameter_mm;
    const double deepest =
        top - (thin_shank ? cutter.tool.stickout_mm - kAboveHolder : cutter.tool.flute_mm);
    writer.take(cutter, cutter.feeds.slot.spindle_rpm, path::MillOperation::Dowels);
    for (path::MillDowel& dowel : plan.dowels) {
        if (deepest > dowel.bottom_z) {
            dowel.bottom_z = deepest;
        }
        bore(writer, program, dowel, cutter);
    }
    if (plan.dowels.front().bottom_z > program.stock.min().z()) {
        plan.warnings.push_back(
            "the dowel holes are " + decomp::decimal(top - plan.dowels.front().bottom_z, 1) +
            " mm deep, not through: drill them through before the block is turned over");
    }
}

decomp::Status plan_bench(Bench& bench, const Roles& roles, path::MillPlan& plan,
                          const MillTask& task, decomp::Run& run) {
    auto maps = untouched(bench, task);
    if (!maps) {
        return decomp::fail(maps.error());
    }
    Writer writer(bench.program);
    if (plan.programs.empty()) {
        bore_dowels(writer, bench.program, plan, *roles.rough.front());
    }
    const Work work{bench, task, writer, *maps};
    const double standing = kStepOfFinisher * roles.finish.front()->tool.diameter_mm;
    bool rest = false;
    for (const Cutter* cutter : roles.rough) {
        auto done = rough(work, *cutter, rest, standing, run);
        if (!done) {
            return done;
        }
        rest = true;
        run.progress("mill", 0.3);
    }
    const cutter::Surface surface(bench.target);
    const tool::Tool& last = roles.finish.back()->tool;
    const double round = tool::cutter_height_mm(last, last.radius_mm()).value_or(0);
    const bool foot_is_open = bench.open && roles.foot != nullptr && round > 0;
    if (foot_is_open) {
        auto done = contour(work, surface, *roles.foot,
                            bench.floor_z + std::min(round, 3.0) + kFootStep, kFootStep, run);
        if (!done) {
            return done;
        }
    }
    rest = false;
    for (const Cutter* cutter : roles.finish) {
        const auto done = finish(work, surface, *cutter, rest, run);
        if (!done) {
            return decomp::fail(done.error());
        }
        const double percent = done->nodes == 0 ? 0
                                                : 100 * static_cast<double>(done->held_up) /
                                                      static_cast<double>(done->nodes);
        if (percent > kHeldUpPercent) {
            plan.warnings.push_back("set-up " + bench.program.name + ": the holder of " +
                                    cutter->tool.name + " keeps it off " +
                                    decomp::decimal(percent, 1) +
                                    " % of what it should finish: a longer tool reaches more");
        }
        rest = true;
    }
    if (roles.foot != nullptr && round > 0) {
        auto done = feet(work, surface, *roles.foot, kFootStep, run);
        if (!done) {
            return done;
        }
    }
    writer.finish();
    return {};
}

}  // namespace

Result<path::MillPlan> plan_milling(const decomp::part::Part& part, const MillTask& task,
                                    decomp::Run& run) {
    const auto roles = roles_of(task);
    if (!roles) {
        return decomp::fail(roles.error());
    }
    auto clamping = clamp_part(part, task, run);
    if (!clamping) {
        return decomp::fail(clamping.error());
    }
    path::MillPlan plan;
    for (const Cutter& cutter : task.cutters) {
        plan.tools.push_back(cutter.tool);
    }
    plan.keeps = clamping->keeps;
    plan.dowels = clamping->dowels;
    plan.flip_axis = clamping->flip_axis;
    plan.warnings = clamping->warnings;
    plan.allowance_mm = task.allowance_mm;
    plan.scallop_mm = task.scallop_mm;
    plan.tolerance_mm = kFinishToleranceMm;
    for (Bench& bench : clamping->benches) {
        const auto done = plan_bench(bench, *roles, plan, task, run);
        if (!done) {
            return decomp::fail(done.error());
        }
        plan.programs.push_back(std::move(bench.program));
    }
    run.progress("mill", 1);
    return plan;
}

}  // namespace cam::mill
