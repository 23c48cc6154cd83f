// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/prove.h"

#include "cam/millproof/stock.h"
#include "cam/millproof/surface.h"
#include "cam/motion/planner.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace cam::millproof {

namespace {

using decomp::fail;

constexpr double kMostCells = 64e6;
constexpr double kSlackMm = 1e-3;
constexpr std::size_t kFaultsOfAKind = 20;
/// Deviation at junctions that hobby controllers and LinuxCNC's G64 P0.01 allow, as a step of speed
/// at a right angle: sqrt(2.41 a d), from v^2 = a d sin(q/2) / (1 - sin(q/2)).
constexpr double kJunctionMm = 0.01;
constexpr double kRightAngle = 2.41;

void check_limits(const std::vector<Step>& steps, const MillJob& job, MillProof& proof) {
    Eigen::AlignedBox3d& box = proof.figures.reached;
    const Eigen::Vector3d room = job.machine.travel.max_mm - job.machine.travel.min_mm;
    bool told_room = false;
    long told_floor = 0;
    for (const Step& step : steps) {
        box.extend(step.from);
        box.extend(step.to);
        if (step.to.z() < job.floor_z - kSlackMm && told_floor != step.line) {
            told_floor = step.line;
            proof.faults.push_back({"floor", step.line,
                                    "the tip goes to Z " + decomp::decimal(step.to.z(), 3) +
                                        ", below what lies under the stock"});
        }
        if (!told_room && !box.isEmpty() && (box.sizes().array() > room.array()).any()) {
            told_room = true;
            proof.faults.push_back({"limits", step.line, "further than the machine's travel"});
        }
    }
}

double seconds_of(const std::vector<Step>& steps, const profile::MillMachine& machine) {
    profile::FdmMachine::Motion motion;
    motion.max_speed_mm_per_s.head<3>() = machine.axes.max_feed_mm_per_min / 60;
    motion.max_acceleration_mm_per_s2.head<3>() = machine.axes.acceleration_mm_per_s2;
    motion.jerk_mm_per_s.head<3>() =
        (machine.axes.acceleration_mm_per_s2 * kJunctionMm * kRightAngle).cwiseSqrt();
    motion.max_speed_mm_per_s[3] = motion.max_acceleration_mm_per_s2[3] = 1;
    motion.jerk_mm_per_s[3] = 1;
    motion::Planner planner(motion);
    for (const Step& step : steps) {
        motion::Segment segment;
        segment.delta_mm.head<3>() = step.to - step.from;
        segment.speed_mm_per_s = step.rapid ? 1e9 : step.mm_per_min / 60;
        segment.acceleration_mm_per_s2 = machine.axes.acceleration_mm_per_s2.maxCoeff() * 2;
        if (segment.speed_mm_per_s > 0) {
            planner.add(segment);
        }
    }
    double sum = 0;
    for (const double seconds : planner.finish()) {
        sum += seconds;
    }
    return sum;
}

void tidy(std::vector<Fault>& faults) {
    std::stable_sort(faults.begin(), faults.end(),
                     [](const Fault& a, const Fault& b) { return a.line < b.line; });
    std::map<std::string, std::size_t> seen;
    std::vector<Fault> kept;
    for (Fault& fault : faults) {
        if (++seen[fault.kind] <= kFaultsOfAKind) {
            kept.push_back(std::move(fault));
        }
    }
    faults = std::move(kept);
}

}  // namespace

decomp::Result<MillProof> prove(std::string_view program, const MillJob& job,
                                const ProofOptions& options) {
    if (job.part == nullptr || job.part->triangles.empty() || job.tools.empty() ||
        job.stock.isEmpty() || !(job.stock.sizes().minCoeff() > 0)) {
        return fail("millproof.job", "a proof needs a part, a tool and a stock");
    }
    const double cells =
        job.stock.sizes().x() * job.stock.sizes().y() / (options.cell_mm * options.cell_mm);
    if (!(cells < kMostCells)) {
        return fail("millproof.job", "the stock's map would have more than 64 million cells", {},
                    "larger cells");
    }
    MillProof proof;
    ProgramPath path = read_program(program, job);
    proof.faults = std::move(path.faults);
    proof.figures.lines = std::count(program.begin(), program.end(), '\n');
    for (const Step& step : path.steps) {
        (step.rapid ? proof.figures.rapid_mm : proof.figures.cut_mm) +=
            (step.to - step.from).norm();
    }
    check_limits(path.steps, job, proof);
    Stock stock(job, options.cell_mm);
    stock.run(path.steps, proof.faults);
    stock.look_for_loose_pieces(proof.faults);
    proof.figures.rapid_hits = stock.rapid_hits();
    proof.stock = std::move(stock).take();
    examine_surface(job, options, path.steps, proof);
    proof.figures.seconds = seconds_of(path.steps, job.machine);
    tidy(proof.faults);
    return proof;
}

}  // namespace cam::millproof
