// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/examine_level.h"
#include "cam/verify/fault_list.h"

#include <vector>

namespace cam::verify {

/// Turns what the levels showed into faults and figures, level by level from the bed up. Serial.
void judge_levels(const Scene& scene, const std::vector<LevelReport>& reports, FaultList& faults,
                  Proof& proof);

}  // namespace cam::verify
