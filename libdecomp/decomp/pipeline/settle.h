// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/run.h"
#include "decomp/part/judge.h"
#include "decomp/part/part.h"
#include "decomp/pipeline/plan.h"

/// Inside the room: from a plane found on a stand-in to the plane that cuts the part itself.
namespace decomp::pipeline {

/// The planned plane, shifted by as little as needed (at most 2 % of the part's extent) so that it
/// breaks off no chip and tongue that the plan does not have, and so that pieces planned to stay
/// whole do. Tried in doubles on the part itself; when no shift does, the one with the fewest
/// faults.
[[nodiscard]] part::Plane settled(const part::Part& part, const PlannedCut& cut,
                                  const part::Judge& judge, const Whole& root, Run& run);

}  // namespace decomp::pipeline
