// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"
#include "decomp/base/units.h"

#include <Eigen/Core>

#include <vector>

namespace cam::fdm {

/// Points of an open line, mm.
using Line = std::vector<Eigen::Vector2d>;

struct FillPattern {
    double spacing_mm = 0.4;
    decomp::Angle angle;       ///< of the lines against X
    double max_link_mm = 1.0;  ///< longest way along the boundary from one line to the next
};

/// Parallel lines inside a region, on a grid fixed to the origin so that the lines of stacked
/// layers meet. Ends of neighbouring lines are linked along the region's boundary, so that the
/// whole is a few long zigzags. The lines go up to the boundary: hand in the region where centre
/// lines may run. O((n + lines) log).
[[nodiscard]] std::vector<Line> fill_with_lines(const polygon::Paths& region,
                                                const FillPattern& pattern);

/// The same lines in the order of printing: none is laid before the one below it, so that all of a
/// surface is swept in one direction and shines alike. Zigzags as long as the region lets them; do
/// not turn them round.
[[nodiscard]] std::vector<Line> fill_in_order(const polygon::Paths& region,
                                              const FillPattern& pattern);

}  // namespace cam::fdm
