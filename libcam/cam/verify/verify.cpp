// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/verify.h"

#include "cam/verify/examine_level.h"
#include "cam/verify/fault_list.h"
#include "cam/verify/judge_levels.h"
#include "cam/verify/limits.h"
#include "cam/verify/missing_layers.h"
#include "cam/verify/replay.h"
#include "decomp/base/hash.h"
#include "decomp/base/number.h"
#include "decomp/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace cam::verify {
namespace {

constexpr std::size_t kBatch = 16;
constexpr double kReachMm = 1.3;  ///< rough deposits are kept that far down

bool names_its_points(const decomp::mesh::TriMesh& mesh) {
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
        return std::all_of(triangle.begin(), triangle.end(),
                           [&](std::uint32_t v) { return v < mesh.points.size(); });
    });
}

decomp::Status check_parts(const std::vector<PlacedPart>& parts, const profile::FdmSetup& setup) {
    constexpr double kFarMm = 100;
    const auto& chamber = setup.machine.chamber;
    for (const PlacedPart& part : parts) {
        if (!names_its_points(part.mesh)) {
            return decomp::fail("proof.bad_part", "a triangle names a point that does not exist",
                                part.id);
        }
        for (const Eigen::Vector3d& point : part.mesh.points) {
            if (!point.allFinite() || ((point - chamber.min_mm).array() < -kFarMm).any() ||
                ((point - chamber.max_mm).array() > kFarMm).any()) {
                return decomp::fail("proof.bad_part", "the part is not in the chamber", part.id,
                                    "give its mesh in the machine's own coordinates");
            }
        }
    }
    return {};
}

/// The facets on which other parts touch this one.
decomp::mesh::TriMesh mating_faces(const PlacedPart& part) {
    decomp::mesh::TriMesh out;
    for (std::size_t i = 0; i < part.mesh.triangles.size() && i < part.mating.size(); ++i) {
        if (part.mating[i]) {
            out.triangles.push_back(part.mesh.triangles[i]);
        }
    }
    if (!out.triangles.empty()) {
        out.points = part.mesh.points;
    }
    return out;
}

/// Levels in batches from the bed up: a level needs the rough deposits of those below, and nothing
/// else of them.
decomp::Result<std::vector<LevelReport>> examine_levels(const Scene& scene,
                                                        const decomp::Run& run) {
    const std::size_t count = scene.levels->levels.size();
    std::vector<LevelReport> reports(count);
    std::vector<Bitmap> rough(count);
    std::size_t kept = 0;
    for (std::size_t first = 0; first < count; first += kBatch) {
        if (run.cancelled()) {
            return decomp::cancelled();
        }
        const std::size_t size = std::min(kBatch, count - first);
        decomp::for_each_index(run, size, [&](std::size_t k) {
            rough[first + k] =
                rough_deposit(*scene.beads, *scene.levels, first + k, scene.pixel_mm);
        });
        decomp::for_each_index(run, size, [&](std::size_t k) {
            reports[first + k] = examine_level(scene, first + k, rough);
        });
        while (kept < first + size &&
               scene.levels->levels[kept].z < scene.levels->levels[first + size - 1].z - kReachMm) {
            rough[kept++] = Bitmap();
        }
        run.progress("verify", static_cast<double>(first + size) / static_cast<double>(count));
    }
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    return reports;
}

}  // namespace

decomp::Result<Proof> examine(std::string_view program, const std::vector<PlacedPart>& parts,
                              const profile::FdmSetup& setup, const Options& options,
                              const decomp::Run& run) {
    if (auto good = check_parts(parts, setup); !good) {
        return decomp::fail(good.error());
    }
    auto replayed = replay(program, setup, options, run);
    if (!replayed) {
        return decomp::fail(replayed.error());
    }
    const Levels levels = sort_levels(replayed->beads);
    std::vector<Slicer> slicers;
    std::vector<std::string> ids;
    std::vector<decomp::mesh::TriMesh> faces;  // must outlive their slicers
    std::transform(parts.begin(), parts.end(), std::back_inserter(faces), mating_faces);
    std::vector<Slicer> mating;
    for (const PlacedPart& part : parts) {
        slicers.emplace_back(part.mesh);
        mating.emplace_back(faces[ids.size()]);
        ids.push_back(part.id);
    }
    const Scene scene{&replayed->beads,
                      &levels,
                      &slicers,
                      &mating,
                      &setup.machine.process,
                      std::clamp(options.pixel_mm, 0.05, 0.2)};
    auto reports = examine_levels(scene, run);
    if (!reports) {
        return decomp::fail(reports.error());
    }
    Proof proof;
    FaultList faults;
    for (Sighting& seen : replayed->sightings) {
        faults.add({std::move(seen.code), seen.line, seen.z >= 0 ? levels.layer_at(seen.z) : -1,
                    std::move(seen.text)});
    }
    Figures& figures = proof.figures;
    figures.lines = replayed->lines;
    figures.filament_mm = replayed->filament_mm;
    figures.extruded_mm3 = replayed->extruded_mm3;
    figures.max_flow_mm3_per_s = replayed->max_flow_mm3_per_s;
    figures.blob_mm3 = replayed->blob_mm3;
    figures.moves_below_printed = replayed->moves_below_printed;
    figures.moves_outside_chamber = replayed->moves_outside_chamber;
    for (const Bead& bead : replayed->beads) {
        figures.declared_mm3 += bead.role == Role::Part ? 0 : static_cast<double>(bead.volume_mm3);
    }
    proof.notes = std::move(replayed->notes);
    if (parts.empty()) {
        proof.notes.emplace_back(
            "no part is given: what the program makes is not compared with anything");
    }
    judge_levels(scene, *reports, faults, proof);
    judge_missing_layers(scene, *reports, replayed->climbs, ids, faults);
    faults.close(proof);
    return proof;
}

decomp::Result<CheckedProgram> check(std::string_view program, const std::vector<PlacedPart>& parts,
                                     const profile::FdmSetup& setup, const Options& options,
                                     const decomp::Run& run) {
    auto proof = examine(program, parts, setup, options, run);
    if (!proof) {
        return decomp::fail(proof.error());
    }
    if (!proof->passed()) {
        decomp::Error error{"proof.failed",
                            std::to_string(proof->faults.size()) + " fault(s) in the program",
                            {},
                            {},
                            {}};
        for (const Fault& fault : proof->faults) {
            error.notes.push_back("line " + std::to_string(fault.line) + ": " + fault.text + " [" +
                                  fault.code + "]");
        }
        return decomp::fail(std::move(error));
    }
    CheckedProgram checked;
    checked.text_ = std::string(program);
    checked.hash_ = decomp::sha256_hex(program);
    checked.proof_ = std::move(*proof);
    return checked;
}

}  // namespace cam::verify
