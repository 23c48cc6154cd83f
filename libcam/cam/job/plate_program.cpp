// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/plate_program.h"

#include "cam/fdm/plan_part.h"
#include "cam/fdm/plate_layers.h"
#include "cam/orient/choose_build.h"
#include "cam/orient/footprint.h"
#include "cam/post/post_fdm.h"
#include "decomp/mesh/measure.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace cam::job {

using decomp::fail;
using decomp::Result;
using decomp::Run;

namespace {

/// Of the time that a plate's program takes, as measured.
constexpr double kPlanningShare = 0.8;

/// The brim's round corners as the corners of a polygon around the circle.
constexpr int kBrimCorners = 16;

}  // namespace

plate::Footprint footprint_of(const std::string& id, const decomp::mesh::TriMesh& printed,
                              const profile::FdmMachine& machine) {
    std::vector<Eigen::Vector2d> shadow;
    for (const Eigen::Vector3d& point : printed.points) {
        shadow.emplace_back(point.head<2>());
    }
    std::vector<Eigen::Vector2d> outline = orient::convex_hull(shadow);
    if (machine.process.brim_width_mm > 0) {
        const double radius =
            orient::border_mm(machine) / std::cos(std::numbers::pi / kBrimCorners);
        std::vector<Eigen::Vector2d> grown;
        for (const Eigen::Vector2d& corner : outline) {
            for (int i = 0; i < kBrimCorners; ++i) {
                // Sides, not corners, face the axes: along them the outline grows by no more than
                // the border that the judge reckons with.
                const double angle = 2 * std::numbers::pi * (i + 0.5) / kBrimCorners;
                grown.emplace_back(corner +
                                   radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
            }
        }
        outline = orient::convex_hull(grown);
    }
    return {id, std::move(outline), decomp::mesh::bounds(printed).max().z()};
}

Eigen::Vector2d middle_of_bed(const profile::FdmMachine& machine) {
    return (0.5 * (machine.chamber.min_mm + machine.chamber.max_mm)).head<2>();
}

decomp::mesh::TriMesh to_part_bed(const decomp::mesh::TriMesh& mesh) {
    const Eigen::AlignedBox3d box = decomp::mesh::bounds(mesh);
    const Eigen::Vector3d middle = box.center();
    const Eigen::Vector3d shift(-middle.x(), -middle.y(), -box.min().z());
    return decomp::mesh::transformed(mesh, Eigen::Affine3d(Eigen::Translation3d(shift)));
}

Result<path::LayerStack> plan_plate(const std::vector<PartOnPlate>& parts,
                                    const profile::FdmSetup& setup, Run& run) {
    std::vector<path::LayerStack> stacks(parts.size());
    std::vector<fdm::PlacedStack> placed;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Run inner = run;
        inner.progress_sink = [&](const decomp::Progress& progress) {
            run.progress(progress.stage, (static_cast<double>(i) + progress.fraction) /
                                             static_cast<double>(parts.size()));
        };
        auto stack = fdm::plan_part(parts[i].mesh, parts[i].mating, setup, inner);
        if (!stack) {
            decomp::Error error = std::move(stack.error());
            error.where = error.where.empty() ? parts[i].id : parts[i].id + ", " + error.where;
            return fail(std::move(error));
        }
        stacks[i] = std::move(*stack);
        placed.push_back({&stacks[i], parts[i].offset_mm});
    }
    return fdm::merge_layers(placed, setup);
}

Result<PlateProgram> program_plate(const std::vector<PartOnPlate>& parts,
                                   const profile::FdmSetup& setup, const std::string& title,
                                   Run& run) {
    Run planning = run;
    planning.progress_sink = [&](const decomp::Progress& progress) {
        run.progress(progress.stage, kPlanningShare * progress.fraction);
    };
    auto layers = plan_plate(parts, setup, planning);
    if (!layers) {
        return fail(std::move(layers.error()));
    }
    auto program = post::post_fdm(*layers, setup, {.title = title}, run);
    if (!program) {
        return fail(std::move(program.error()));
    }
    const motion::Estimate& estimate = program->estimate;
    return PlateProgram{
        std::move(program->text),
        {estimate.seconds, estimate.filament_mm, estimate.filament_g, estimate.cost},
        std::move(*layers)};
}

std::vector<verify::PlacedPart> placed_parts(const std::vector<PartOnPlate>& parts) {
    std::vector<verify::PlacedPart> placed;
    for (const PartOnPlate& part : parts) {
        const Eigen::Affine3d map(bed_from_part(part.offset_mm).map());
        placed.push_back({part.id, decomp::mesh::transformed(part.mesh, map), part.mating});
    }
    return placed;
}

ProofFacts proof_facts(const verify::Proof& proof) {
    ProofFacts facts;
    facts.passed = proof.passed();
    facts.faults = proof.faults.size();
    if (!proof.faults.empty()) {
        const verify::Fault& fault = proof.faults.front();
        facts.first_fault =
            (fault.line > 0 ? "line " + std::to_string(fault.line) + ": " : std::string()) +
            fault.code + ": " + fault.text;
    }
    facts.out_of_part_percent = proof.figures.out_of_part_percent;
    facts.uncovered_skin_percent = proof.figures.uncovered_skin_percent;
    facts.solid_fill_ratio = proof.figures.solid_fill_ratio;
    facts.max_flow_mm3_per_s = proof.figures.max_flow_mm3_per_s;
    facts.floating_islands = proof.figures.floating_islands;
    return facts;
}

}  // namespace cam::job
