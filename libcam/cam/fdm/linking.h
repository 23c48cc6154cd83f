// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/fdm/edge_grid.h"
#include "cam/fdm/infill.h"

#include <array>
#include <vector>

namespace cam::fdm {

/// A line inside a region whose ends lie on the region's boundary.
struct BoundedLine {
    Line points;
    std::array<BoundaryPoint, 2> ends;
};

/// The pieces of a line inside a region; the line begins and ends outside.
void append_inside(const Line& line, const EdgeGrid& region, std::vector<BoundedLine>& out);

/// Joins lines by their ends along the boundary, the nearest ends first, over ways of at most
/// `max_link_mm`. No stretch of the boundary is used twice and no ring is closed. Ends that are
/// left over hold on to the boundary by a hook. Not above 0: neither links nor hooks.
[[nodiscard]] std::vector<Line> linked(std::vector<BoundedLine> lines, const EdgeGrid& region,
                                       double max_link_mm);

}  // namespace cam::fdm
