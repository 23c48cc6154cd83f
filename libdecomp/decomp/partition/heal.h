// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/partition/partition.h"
#include "decomp/partition/votes.h"

#include <cstdint>
#include <vector>

/// Inside the room: from cut regions to parts.
namespace decomp::partition {

/// The label of each atom: the box with most votes; without any, that of the neighbour which it
/// touches most. Then pieces of a label other than its best one, and pieces thinner than allowed,
/// go to the neighbour label which they touch most, smallest first. Bodies without neighbour or
/// votes get labels of their own, from the number of boxes on.
[[nodiscard]] std::vector<std::int32_t> healed_labels(const cut::Complex& complex,
                                                      const std::vector<Atom>& atoms,
                                                      double least_thickness_mm, Figures& figures);

}  // namespace decomp::partition
