// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/cut/cells.h"
#include "decomp/cut/exact.h"

#include <array>
#include <cstdint>
#include <vector>

namespace decomp::cut {

/// One edge in a plane, with the turns it gives to the two chains: above, below in {-1, 0, +1}
/// along `ref`.
struct ChainEdge {
    Ref ref = 0;
    std::int8_t above = 0;
    std::int8_t below = 0;
};

/// A connected piece of a plane.
struct PlanarPiece {
    std::vector<Ref> loop;           ///< counter-clockwise; holes and cracks included
    std::vector<std::int32_t> lone;  ///< vertices strictly inside
};

/// The connected pieces of the plane where chain `above` winds +1 and chain `below` winds -1 at
/// once. Edges that both chains cross to no effect (cracks) and `lone` vertices inside a piece stay
/// part of it.
/// @error cut.crossing_constraints  edges cross, a vertex lies on an edge, or a winding is not 0 or
/// 1
[[nodiscard]] Result<std::vector<PlanarPiece>> common_pieces(const Cells& cells,
                                                             Projection projection,
                                                             const std::vector<ChainEdge>& chain,
                                                             const std::vector<std::int32_t>& lone);

using VertexTriangle = std::array<std::int32_t, 3>;

/// The triangles of one face, counter-clockwise about the normal of its carrier: the constrained
/// Delaunay triangulation, or for a convex piece of an input triangle a choice that avoids thin
/// ears.
/// @error cut.crossing_constraints  as above
[[nodiscard]] Result<std::vector<VertexTriangle>> triangles_of(const Cells& cells,
                                                               const Face& face);

}  // namespace decomp::cut
