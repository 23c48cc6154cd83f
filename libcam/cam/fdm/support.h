// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"
#include "decomp/base/run.h"
#include "decomp/base/units.h"

#include <vector>

namespace cam::fdm {

struct SupportOptions {
    decomp::Angle
        angle;  ///< faces flatter than this against the horizontal need support; 0: islands only
    double layer_height_mm = 0.2;
    double line_width_mm = 0.45;
    int gap_layers = 1;        ///< left free between support and the part above it
    double gap_xy_mm = 0.6;    ///< left free beside the part
    double spacing_mm = 2.5;   ///< of the lines in columns: their dense tops reach over to the next
    int interface_layers = 3;  ///< dense ones under the part
};

/// What of one layer is support; the two areas do not overlap.
struct SupportAreas {
    polygon::Paths body;
    polygon::Paths interface;  ///< the topmost layers under the part: dense
};

/// Columns of support under whatever hangs too far out or begins in the air, down to the bed or to
/// the part. Overhangs of less than half a line a layer need none. Islands, which touch nothing of
/// the layer below, always get a column, close to the part if there is no other room. A column too
/// slender to stand widens downwards.
/// @param carried  per layer, what bridges carry: needs no support
/// Columns come down serially, the rest is parallel over layers.
[[nodiscard]] std::vector<SupportAreas> find_supports(const std::vector<polygon::Paths>& slices,
                                                      const std::vector<polygon::Paths>& carried,
                                                      const SupportOptions& options,
                                                      const decomp::Run& run);

/// What of an area may fall between two lines that are `spacing_mm` apart.
[[nodiscard]] polygon::Paths between_lines(const polygon::Paths& area, double spacing_mm);

}  // namespace cam::fdm
