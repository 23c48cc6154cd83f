// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/job_file.h"
#include "decomp/base/run.h"
#include "decomp/brep/write_step.h"

#include <vector>

namespace cam::job {

/// The block around a part in its part bed frame, as `--step-stock` asks for it: the part's extent,
/// larger by `room_mm` on the four sides and on top; below, both end at z = 0.
/// @error those of solid::make_solid()
[[nodiscard]] decomp::Result<decomp::brep::StepBody> stock_body(const PartFacts& part,
                                                                double room_mm,
                                                                const decomp::Run& run);

/// The models that `--step-fixture` names, one body each, as they stand in their files: these have
/// the part bed frame, too.
/// @error those of read_solid() and solid::make_solid()
[[nodiscard]] decomp::Result<std::vector<decomp::brep::StepBody>> fixture_bodies(
    const StepWish& wish, double tolerance_mm, decomp::Run& run);

}  // namespace cam::job
