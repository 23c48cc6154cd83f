// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace cam::mill {

/// Something to be cut from one end to the other.
struct Stretch {
    Eigen::Vector2d first = Eigen::Vector2d::Zero();
    Eigen::Vector2d last = Eigen::Vector2d::Zero();
};

/// Which stretch comes next, and whether it is run from its last end.
struct Turn {
    std::size_t index = 0;
    bool backwards = false;
};

/// A short way through all stretches from `start`: nearest neighbour, then 2-opt over neighbours in
/// the order, until nothing improves or a counted budget is spent. Ties: the lower index.
/// Deterministic. O(n^2).
[[nodiscard]] std::vector<Turn> short_order(const std::vector<Stretch>& stretches,
                                            const Eigen::Vector2d& start);

}  // namespace cam::mill
