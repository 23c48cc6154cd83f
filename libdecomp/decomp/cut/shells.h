// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/cut/cells.h"

#include <cstdint>
#include <vector>

namespace decomp::cut {

/// One face at an edge that more than two faces share. forward: seen from outside, the face runs
/// the edge from `from` to `to` counter-clockwise.
struct Wing {
    Carrier carrier;
    bool flipped = false;
    bool forward = false;
};

/// For each wing the one on the other side of the material wedge next to it, exactly; -1 where
/// there is none, which means that the wings do not bound a volume.
[[nodiscard]] std::vector<std::int32_t> partners(const Cells& cells, std::int32_t from,
                                                 std::int32_t to, const std::vector<Wing>& wings);

/// The faces of a region, each turned outward.
[[nodiscard]] std::vector<FaceSide> sides_of(const Cells& cells, std::int32_t region);

struct Bodies {
    std::vector<std::int32_t> body;  ///< of each side, in order of the first side of the body
    std::int32_t count = 0;
};

/// Takes closed, outward oriented sides apart into bodies: outer shells with the voids directly
/// inside them. Shells that only touch along edges or at points are apart.
/// @error cut.not_a_volume  the sides do not bound a volume
[[nodiscard]] Result<Bodies> bodies_of(const Cells& cells, const std::vector<FaceSide>& sides);

}  // namespace decomp::cut
