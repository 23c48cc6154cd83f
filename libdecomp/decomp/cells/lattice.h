// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/tets/tet_mesh.h"

namespace decomp::cells {

/// The planes in which the boundary of a polycube lies, for a pair whose labels are not known: its
/// facets within 25 degrees of an axis are gathered by their coordinate along it.
/// @param merge_share  of the extent: planes closer than this become one
/// @error cells.bad_pair  no facet faces along some axis: the second mesh is no polycube
/// O(n log n).
[[nodiscard]] Result<tets::Lattice> lattice_from(const tets::Pair& pair, double merge_share = 0.05);

}  // namespace decomp::cells
