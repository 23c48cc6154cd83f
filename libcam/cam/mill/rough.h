// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/mill/task.h"
#include "cam/mill/work.h"
#include "decomp/base/run.h"

namespace cam::mill {

/// Takes the stock down level by level with one tool, leaving the allowance, and updates the map of
/// the stock. At each level rings an offset apart, the innermost first: it alone cuts with its
/// whole width, at the slot's feed; each further one has at most a stepover to take. Rings are
/// entered by a ramp along themselves, or from their neighbour when the way is clear.
/// Of a second tool only what the first has left is cut.
/// @param deepest_step_mm  of a level: what the finishing tool can take in one go
/// @error run.cancelled
[[nodiscard]] decomp::Status rough(const Work& work, const Cutter& cutter, bool rest_only,
                                   double deepest_step_mm, decomp::Run& run);

}  // namespace cam::mill
