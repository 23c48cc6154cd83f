// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"
#include "cam/profile/read_profile.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>

namespace cam::motion {

enum class MoveKind : std::uint8_t {
    NewLayer,  ///< nothing moves; the moves that follow belong to `layer`
    Retract,   ///< filament back
    Raise,     ///< to the height of a travel
    Travel,
    Lower,    ///< to the height of the layer
    Recover,  ///< filament forward again
    Extrude,  ///< along a bead
    Wipe,     ///< back along a bead, filament back
    Pause,    ///< stand still for `seconds`
};

/// One thing that the machine does. Frame: that of the stack.
struct Move {
    MoveKind kind = MoveKind::NewLayer;
    std::size_t layer = 0;
    const path::Bead* bead = nullptr;  ///< of Extrude
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    double filament_mm = 0;     ///< fed during this move; negative: pulled back
    double seconds = 0;         ///< of Pause
    double speed_mm_per_s = 0;  ///< along the path, or of the filament when nothing else moves
};

/// Filament per mm of a bead, extrusion multiplier included.
[[nodiscard]] double filament_per_mm(const path::Bead& bead, const profile::FdmSetup& setup);

/// The speed at which a bead is printed: as wished, unless nozzle or material cannot melt that
/// much.
[[nodiscard]] double bead_speed_mm_per_s(const path::Bead& bead, const profile::FdmSetup& setup);

/// Calls `sink` with every move of a stack in order: beads at their speed but not beyond the flow
/// that nozzle and material stand, travels by their approaches, retracted and lifted when they are
/// long or change the layer; those inside the part are retracted only beyond a length of their own.
/// Begins recovered, at the place of the first travel; ends retracted. Serial, O(points).
void trace(const path::LayerStack& stack, const profile::FdmSetup& setup,
           const std::function<void(const Move&)>& sink);

}  // namespace cam::motion
