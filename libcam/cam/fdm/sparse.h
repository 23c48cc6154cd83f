// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/fdm/infill.h"
#include "cam/polygon/polygon.h"
#include "decomp/base/units.h"

#include <string>
#include <vector>

namespace cam::fdm {

/// The shapes of sparse infill. In each, the lines of one layer lie on, or just beside, those of
/// the layer below.
enum class SparsePattern {
    Grid,         ///< two directions on every layer
    Rectilinear,  ///< one direction, crossed on the next layer
    Gyroid,       ///< sections of the surface sin x cos y + sin y cos z + sin z cos x = 0
    Cubic,        ///< sections of cubes that stand on a corner
    Concentric,   ///< the outline again and again
};

/// As the profile names it. An unknown name is a bug: profiles are checked when they are read.
[[nodiscard]] SparsePattern sparse_pattern(const std::string& name);

struct SparseFill {
    SparsePattern pattern = SparsePattern::Grid;
    double density = 0.15;         ///< share of the region that beads cover, 0..1
    double bead_spacing_mm = 0.4;  ///< what one bead covers
    decomp::Angle angle;           ///< of the first lines against X
    double z_mm = 0;               ///< of the layer
    bool odd_layer = false;
    double max_link_mm = 20;  ///< longest way along the boundary from line to line; 0: none
};

/// Lines with `density` of their region covered, whatever the pattern. They end on the region's
/// boundary, where neighbouring ends are linked such that no stretch of the boundary is gone twice:
/// hand in the region where centre lines may run. O(lines * cells passed).
[[nodiscard]] std::vector<Line> fill_sparsely(const polygon::Paths& region, const SparseFill& fill);

}  // namespace cam::fdm
