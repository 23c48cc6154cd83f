// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/tets/tet_mesh.h"

namespace decomp::tets {

/// Joins a shape and its polycube, as two files hold them, into a pair. The tets may be listed in
/// another order, and their corners too; they are those of the shape, turned positive there. Tets
/// without volume in the shape are kept (they count as flipped nowhere and vote for nothing).
/// @error tets.connectivity  the two differ in points or tets: the first difference is named
/// @error tets.empty         no tet
/// O(n log n).
[[nodiscard]] Result<Pair> pair_of(TetMesh shape, TetMesh polycube);

}  // namespace decomp::tets
