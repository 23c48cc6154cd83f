// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/mill/setup.h"
#include "cam/mill/task.h"
#include "cam/path/mill_program.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/part/part.h"

namespace cam::mill {

/// Plans a part's milling from the block to the finished part: set-ups, dowel holes, roughing,
/// roughing of what is left, the foot of the outline, finishing, finishing of what is left.
///
/// The first cutter that can rough clears; further ones rough what it leaves; the cutters with a
/// round tip finish, in order (without one, the last that can).
/// @error those of clamp_part(), check.raster_too_large, mill.no_cutter, run.cancelled
/// The same plan whatever run.jobs. Cost: tests/bench/mill_bench.cpp.
[[nodiscard]] decomp::Result<path::MillPlan> plan_milling(const decomp::part::Part& part,
                                                          const MillTask& task, decomp::Run& run);

}  // namespace cam::mill
