// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/millproof/heights.h"
#include "cam/millproof/prove.h"

#include <array>
#include <vector>

namespace cam::millproof {

/// What the tools can leave at best, from part and tools alone: the part's map of heights, closed
/// by each tool (lowered onto it everywhere, then taken away from below), the lowest of all.
class Reach {
  public:
    /// Cost: cells times cells under a tool, twice.
    Reach(const MillJob& job, double cell_mm);

    /// The height that can be had at a point, between the four cells about it.
    [[nodiscard]] double level(const Eigen::Vector2d& at) const;

    /// The highest of those four.
    [[nodiscard]] double highest_around(const Eigen::Vector2d& at) const;

  private:
    [[nodiscard]] std::array<double, 4> around(const Eigen::Vector2d& at) const;

    Nodes cells_;
    std::vector<float> closed_;
};

}  // namespace cam::millproof
