// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/fdm/bridge.h"
#include "cam/polygon/polygon.h"
#include "decomp/base/run.h"

#include <vector>

namespace cam::fdm {

/// What the inside of one layer is filled with; the areas do not overlap.
struct Interior {
    polygon::Paths solid;           ///< within the skin's thickness of a top or bottom surface
    polygon::Paths sparse;          ///< the rest
    polygon::Paths open_to_top;     ///< where the next layer leaves the inside bare
    polygon::Paths open_to_bottom;  ///< where there is nothing below, the bed excepted
    std::vector<BridgeArea> bridges;
};

struct SkinOptions {
    int top_layers = 5;
    int bottom_layers = 4;
    double spacing_mm = 0.4;  ///< of solid lines
    bool all_solid = false;   ///< 100 % infill
    double cell_mm = 0;       ///< widest gap between lines of infill; 0: there are none
};

/// Splits the inside of every layer. Solid is what has not `top_layers` slices above it and
/// `bottom_layers` below it, widened so that it is anchored in the infill or rests on its lines,
/// and what would be too small for infill. Parallel over layers.
[[nodiscard]] std::vector<Interior> split_interiors(const std::vector<polygon::Paths>& slices,
                                                    const std::vector<polygon::Paths>& insides,
                                                    const SkinOptions& options,
                                                    const decomp::Run& run);

}  // namespace cam::fdm
