// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/job_file.h"
#include "cam/path/layers.h"
#include "cam/plate/pack.h"
#include "cam/profile/read_profile.h"
#include "cam/verify/verify.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <string>
#include <string_view>
#include <vector>

namespace cam::job {

/// A part as it is printed (part bed frame) and where it stands on the plate.
struct PartOnPlate {
    std::string id;
    decomp::mesh::TriMesh mesh;
    Eigen::Vector2d offset_mm = Eigen::Vector2d::Zero();
    std::vector<bool> mating = {};  ///< for each triangle: another part touches it; empty: none
};

struct PlateProgram {
    std::string text;
    ProgramFacts facts;
    path::LayerStack layers;  ///< what the program prints, in the bed frame
};

/// The middle of the chamber's floor, where a lone part stands.
[[nodiscard]] Eigen::Vector2d middle_of_bed(const profile::FdmMachine& machine);

/// The mesh moved so that it stands on z = 0 with its bounding box about x = y = 0.
[[nodiscard]] decomp::mesh::TriMesh to_part_bed(const decomp::mesh::TriMesh& mesh);

/// What a part takes on the bed: the convex hull of its shadow with its brim. The skirt belongs to
/// the plate.
[[nodiscard]] plate::Footprint footprint_of(const std::string& id,
                                            const decomp::mesh::TriMesh& printed,
                                            const profile::FdmMachine& machine);

/// The layers of a whole plate in the bed frame: parts planned one by one, moved and merged.
[[nodiscard]] decomp::Result<path::LayerStack> plan_plate(const std::vector<PartOnPlate>& parts,
                                                          const profile::FdmSetup& setup,
                                                          decomp::Run& run);

/// Plans the plate and writes its program; small layers are slowed.
/// @error those of fdm, motion and post; run.cancelled
[[nodiscard]] decomp::Result<PlateProgram> program_plate(const std::vector<PartOnPlate>& parts,
                                                         const profile::FdmSetup& setup,
                                                         const std::string& title,
                                                         decomp::Run& run);

/// Where the proof expects the parts: the same offsets, in the machine's coordinates.
[[nodiscard]] std::vector<verify::PlacedPart> placed_parts(const std::vector<PartOnPlate>& parts);

/// The figures of a proof that job.json and report.json carry.
[[nodiscard]] ProofFacts proof_facts(const verify::Proof& proof);

}  // namespace cam::job
