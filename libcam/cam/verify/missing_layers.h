// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/examine_level.h"
#include "cam/verify/fault_list.h"

#include <string>
#include <vector>

namespace cam::verify {

/// Layers that a part should have and has not: steps that are too high, a missing foot or head, a
/// part that is not made at all. `climbs` says where in the program the missing layer should be.
void judge_missing_layers(const Scene& scene, const std::vector<LevelReport>& reports,
                          const std::vector<Climb>& climbs,
                          const std::vector<std::string>& part_ids, FaultList& faults);

}  // namespace cam::verify
