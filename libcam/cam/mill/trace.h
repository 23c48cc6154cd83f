// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace cam::mill {

/// A line of points; a closed one does not repeat its first.
struct Chain {
    std::vector<Eigen::Vector2d> points;
    bool closed = false;
};

/// Values at the nodes of a square lattice, row by row.
struct Lattice {
    int columns = 0;
    int rows = 0;
    std::vector<float> values;

    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }

    [[nodiscard]] float at(int column, int row) const { return values[index(column, row)]; }
};

/// Where a lattice crosses a level, in units of its nodes: what is at or below the level lies to
/// the left. Marching squares; saddles keep what is above together. Lines end where `wanted` says
/// no to a cell (given by its lower left node) and at the border.
/// @param crossing  the place between a node at or below the level and its neighbour above it;
/// none:
///                  linear
/// Deterministic. O(cells).
[[nodiscard]] std::vector<Chain> trace_level(
    const Lattice& lattice, double level,
    const std::function<bool(int column, int row)>& wanted = {},
    const std::function<Eigen::Vector2d(const Eigen::Vector2d& below,
                                        const Eigen::Vector2d& above)>& crossing = {});

}  // namespace cam::mill
