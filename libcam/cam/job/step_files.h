// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/job_file.h"
#include "cam/job/stage.h"
#include "decomp/base/run.h"

#include <filesystem>
#include <string>
#include <vector>

namespace cam::job {

/// Deviation that is allowed unless --step-tol says otherwise: printed parts.
inline constexpr double kPrintedStepMm = 0.05;

/// What the STEP files of a job depend on: its parts, their poses and what was wished.
[[nodiscard]] StageKey step_key(const JobFile& job, const StageRunner& stages);

/// step/P01.step …: every part as a solid in its part bed frame, where z = 0 is the bed and the
/// program's zero; step/assembly.step: all of them in the model frame, named and coloured as in the
/// pictures. A part whose solid does not pass the kernel's check is made again with flat faces
/// alone, then with its triangles. Stock and fixtures, where wished, are further bodies of each
/// part's file, not of the assembly. Fills in JobFile::step_parts.
/// @error job.step_unsound, those of read_solid(), those of solid::make_solid() and
/// brep::write_step()
[[nodiscard]] decomp::Result<std::vector<FileBytes>> step_files(
    const std::filesystem::path& directory, JobFile& job, decomp::Run& run);

/// `hew export`: writes the STEP files of a finished job and records them in job.json, so that
/// `hew make` keeps them up to date.
/// @error as step_files(), job.busy, file.unwritable
[[nodiscard]] decomp::Result<JobFile> export_step(const std::filesystem::path& directory,
                                                  const StepWish& wish, const decomp::Run& run);

}  // namespace cam::job
