// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"
#include "cam/profile/read_profile.h"

#include <vector>

namespace cam::motion {

/// What printing a stack takes. Homing, heating and priming, which the start template does, are not
/// in it.
struct Estimate {
    double seconds = 0;
    double filament_mm = 0;
    double filament_g = 0;
    double cost = 0;  ///< in the currency of the material's cost_per_kg; 0 when that is unknown
    std::vector<double> layer_seconds;
};

/// Times all moves of a stack by the planner of planner.h. Serial, O(points).
[[nodiscard]] Estimate estimate(const path::LayerStack& stack, const profile::FdmSetup& setup);

}  // namespace cam::motion
