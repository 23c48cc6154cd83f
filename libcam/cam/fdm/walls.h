// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/fdm/bead_size.h"
#include "cam/fdm/infill.h"
#include "cam/polygon/polygon.h"

#include <vector>

namespace cam::fdm {

/// The walls of one layer.
struct Walls {
    std::vector<polygon::Paths> loops;  ///< closed centre lines; loops[0] is the outer wall
    polygon::Paths inside;              ///< what the walls enclose, up to the edge of the innermost
    polygon::Paths thin;  ///< parts of the region too narrow for an outer wall on both sides
    polygon::Paths gaps;  ///< strips between walls, too narrow for another pair
};

/// Lays `count` walls inside a region: the first half a width from the boundary, each further one a
/// spacing inwards.
[[nodiscard]] Walls make_walls(const polygon::Paths& region, const BeadSize& bead, int count);

/// The loops as they are printed: closed, first point = last point, without points that nobody
/// would miss.
[[nodiscard]] std::vector<Line> closed_lines(const polygon::Paths& loops);

}  // namespace cam::fdm
