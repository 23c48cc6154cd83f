// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/motion/moves.h"
#include "cam/path/layers.h"
#include "cam/profile/read_profile.h"

#include <cstddef>
#include <vector>

namespace cam::motion {

/// Numbers the pieces of a print in the order of its moves: a bead and the way to it; what comes
/// after the last bead of a layer is a piece too.
class PieceCounter {
  public:
    /// The piece to which the next move of trace() belongs.
    std::size_t piece_of(const Move& move);

  private:
    std::size_t piece_ = 0;
    std::size_t layer_ = 0;
    const path::Bead* bead_ = nullptr;  ///< the last one of this piece
};

/// What printing a stack takes. Homing, heating and priming, which the start template does, are not
/// in it.
struct Estimate {
    double seconds = 0;
    double filament_mm = 0;
    double filament_g = 0;
    double cost = 0;  ///< in the currency of the material's cost_per_kg; 0 when that is unknown
    std::vector<double> layer_seconds;
    std::vector<double> piece_seconds;  ///< see PieceCounter
};

/// Times all moves of a stack by the planner of planner.h. Serial, O(points).
[[nodiscard]] Estimate estimate(const path::LayerStack& stack, const profile::FdmSetup& setup);

}  // namespace cam::motion
