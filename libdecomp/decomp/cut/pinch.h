// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cut/cells.h"

#include <cstdint>
#include <vector>

namespace decomp::cut {

/// Leaves at which one region has more than two faces: it touches itself there. Ascending.
/// O(faces).
[[nodiscard]] std::vector<std::int32_t> pinched_edges(const Cells& cells);

/// Gives pinched edges a vertex in their middle. Written parts have one copy of it for each wedge
/// of material, so that no two edges of a part run between the same two points. An edge whose ends
/// are neighbouring doubles is left as it is. Adds planes that carry no cut.
void bisect(Cells& cells, const std::vector<std::int32_t>& edges);

}  // namespace decomp::cut
