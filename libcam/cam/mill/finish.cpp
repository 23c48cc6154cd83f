// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/finish.h"

#include "cam/mill/finishing_detail.h"

namespace cam::mill {

namespace {

constexpr double kRowShare = 0.928;  // of the stepover: up to that slope no higher scallops
constexpr double kLevelShare = 0.8;  // of the stepover: levels on slopes not quite upright

}  // namespace

decomp::Result<Finished> finish(const Work& work, const cutter::Surface& surface,
                                const Cutter& cutter, bool rest_only, decomp::Run& run) {
    const Bench& bench = work.bench;
    check::HeightMap& stock = work.maps.stock;
    Finishing finishing(
        work, cutter,
        Tip(surface, cutter.tool, body_tips(stock, cutter.tool, work.task), bench.floor_z));
    const double step = stepover_mm(cutter.tool, work.task.scallop_mm);
    if (!finishing.sample(kRowShare * step, run)) {
        return decomp::cancelled();
    }
    finishing.sort_by_slope(rest_only);
    finishing.levels(bench.program.stock.max().z(), bench.floor_z, kLevelShare * step);
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    finishing.lines(rest_only ? path::MillOperation::RestFinish : path::MillOperation::Parallel);
    remove(stock, finishing.heights_on(stock), cutter.tool);
    return finishing.figures();
}

decomp::Status feet(const Work& work, const cutter::Surface& surface, const Cutter& cutter,
                    double step_mm, decomp::Run& run) {
    Finishing finishing(
        work, cutter,
        Tip(surface, cutter.tool, body_tips(work.maps.stock, cutter.tool, work.task),
            work.bench.floor_z));
    if (!finishing.sample(step_mm, run)) {
        return decomp::cancelled();
    }
    finishing.sort_feet();
    finishing.lines(path::MillOperation::RestFinish);
    return {};
}

decomp::Status contour(const Work& work, const cutter::Surface& surface, const Cutter& cutter,
                       double from_z, double step_mm, decomp::Run& run) {
    const double floor_z = work.bench.floor_z;
    Finishing finishing(
        work, cutter,
        Tip(surface, cutter.tool, body_tips(work.maps.stock, cutter.tool, work.task), floor_z));
    if (!finishing.sample(step_mm, run)) {
        return decomp::cancelled();
    }
    finishing.mark_all_levels();
    finishing.levels(from_z, floor_z, step_mm);
    return {};
}

}  // namespace cam::mill
