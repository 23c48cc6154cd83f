// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/job_file.h"
#include "cam/job/stage.h"
#include "decomp/base/run.h"

#include <filesystem>
#include <string>
#include <vector>

namespace cam::job {

enum class Extent {
    Parts,     ///< stop when the parts are cut, drawn and reported
    Programs,  ///< go on to plates, programs and proofs
};

struct MakeRequest {
    std::filesystem::path model;
    std::filesystem::path directory;
    JobOptions options;
    Extent extent = Extent::Programs;
    bool force = false;  ///< write into a directory that holds other things, or another model's job
};

struct MakeResult {
    JobFile job;
    std::vector<StageTiming> timings;
};

/// The main job: reads and repairs the model, cuts it into parts that the machine can make,
/// arranges them on plates, writes and proves a program for every plate, draws and reports. Stages
/// whose inputs have not changed since an earlier run in the same directory are kept. A failed
/// proof is no error here: see Totals::passed.
/// @error job.not_empty, job.other_model, job.busy, and those of the rooms that it composes
[[nodiscard]] decomp::Result<MakeResult> make(const MakeRequest& request, decomp::Run& run);

/// What make() would do, found out without writing anything.
struct MakePlan {
    InputFile input;
    JobOptions options;
    std::string profile_sha256;
    Eigen::Vector3d extent_mm =
        Eigen::Vector3d::Zero();  ///< of the model, in the model frame, before repair
    Eigen::Vector3d chamber_mm =
        Eigen::Vector3d::Zero();  ///< what the machine can hold, margins off
    int blocks =
        1;  ///< chamber-sized blocks that would hold the model: about how many parts to expect
    std::vector<std::string> kept;  ///< stages of an earlier run that still hold
    bool complete = false;          ///< nothing would be made
};

/// @error as make(), as far as the checks go
[[nodiscard]] decomp::Result<MakePlan> plan_make(const MakeRequest& request, decomp::Run& run);

}  // namespace cam::job
