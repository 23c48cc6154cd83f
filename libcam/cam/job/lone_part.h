// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/job_file.h"
#include "cam/job/plate_program.h"
#include "cam/profile/read_profile.h"
#include "cam/verify/verify.h"
#include "decomp/base/run.h"
#include "decomp/io/read_mesh.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// What the verbs do outside of the main job: one part alone, one program alone.
namespace cam::job {

/// A mesh file and how to read it.
struct MeshRequest {
    std::filesystem::path path;
    std::string unit;
    double scale = 1;
    std::string up = "z";
    std::optional<double> height_mm;
    std::string body;
    std::optional<double> deflection_mm;
    double angle_deg = 20;
};

/// How the model file of a request or a job is read.
[[nodiscard]] decomp::io::ReadOptions read_options(const MeshRequest& request);
[[nodiscard]] decomp::io::ReadOptions read_options(const JobOptions& options);

/// Reads, turns, scales and repairs a mesh: the shape in the model frame.
/// @error those of io and repair
[[nodiscard]] decomp::Result<decomp::mesh::TriMesh> read_solid(const MeshRequest& request,
                                                               decomp::Run& run);

/// As read_solid(), without repair: whatever can be drawn.
[[nodiscard]] decomp::Result<decomp::mesh::TriMesh> read_drawable(const MeshRequest& request,
                                                                  decomp::Run& run);

/// read_solid(), standing in the middle of the bed as it lies in its file.
[[nodiscard]] decomp::Result<PartOnPlate> read_lone_part(const MeshRequest& request,
                                                         const profile::FdmSetup& setup,
                                                         decomp::Run& run);

/// The profile that a job was made for. @error those of profile; job.profile_changed
[[nodiscard]] decomp::Result<profile::FdmSetup> setup_of(const JobFile& job,
                                                         const std::filesystem::path& directory);

/// A part of a job in the pose in which it is printed, standing at `offset_mm`.
/// @error job.no_such_part, job.changed, those of io
[[nodiscard]] decomp::Result<PartOnPlate> job_part(const std::filesystem::path& directory,
                                                   const JobFile& job, const std::string& id,
                                                   const Eigen::Vector2d& offset_mm);

/// All parts of one plate of a job, where they stand.
[[nodiscard]] decomp::Result<std::vector<PartOnPlate>> job_plate(
    const std::filesystem::path& directory, const JobFile& job, const PlateFacts& plate);

/// All parts of a job in the model frame. @error job.changed, those of io
[[nodiscard]] decomp::Result<decomp::part::Assembly> read_assembly(
    const std::filesystem::path& directory, const JobFile& job);

/// A program with its proof.
struct ProvedProgram {
    std::string text;
    std::string sidecar;  ///< text of PROGRAM.proof.json
    ProgramFacts facts;
    cam::verify::Proof proof;
    path::LayerStack layers;
};

/// Writes the program for these parts on one plate and proves it. A failed proof is no error: see
/// Proof::passed().
/// @error job.part_too_large, those of program_plate() and verify::examine()
[[nodiscard]] decomp::Result<ProvedProgram> slice_and_prove(const std::vector<PartOnPlate>& parts,
                                                            const profile::FdmSetup& setup,
                                                            const std::string& title,
                                                            decomp::Run& run);

}  // namespace cam::job
