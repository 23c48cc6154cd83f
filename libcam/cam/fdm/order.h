// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"

#include <Eigen/Core>

#include <vector>

namespace cam::fdm {

/// The beads of one island of a layer, by the step in which they are laid.
struct IslandBeads {
    std::vector<path::Bead> inner_walls;
    std::vector<path::Bead> outer_walls;
    std::vector<path::Bead> gaps;  ///< single beads in thin walls and between walls
    std::vector<path::Bead> fill;
    std::vector<path::Bead> top;  ///< in the order and direction of printing, after the rest
};

/// Whether outer walls begin where they are said to, or wherever is nearest.
enum class Seams { Kept, Free };

/// All beads in printing order: islands by nearest neighbour, in each the inner walls, the outer
/// walls, the fill. Open beads may be turned round; inner walls start where the nozzle is, and so
/// do outer walls whose seams are free.
[[nodiscard]] std::vector<path::Bead> ordered(std::vector<IslandBeads> islands,
                                              const Eigen::Vector2d& start_mm, Seams seams);

/// Open beads by nearest neighbour, then improved by turning round stretches of the sequence
/// (2-opt) while that shortens the travel.
[[nodiscard]] std::vector<path::Bead> ordered_by_travel(std::vector<path::Bead> beads,
                                                        const Eigen::Vector2d& start_mm);

/// Turns a closed bead (first point = last point) so that it starts at vertex `index`.
void start_at(path::Bead& loop, std::size_t index);

}  // namespace cam::fdm
