// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

#include <vector>

namespace decomp::repair {

/// Cuts the triangles of a closed manifold along all lines in which they cross each other, with
/// exact constructions; coordinates are rounded to double at the end and equal points merged.
/// @error repair.failed
[[nodiscard]] Result<mesh::TriMesh> cut_along_crossings(const mesh::TriMesh& mesh);

/// The boundary of what a surface that crosses itself winds around at least once:
/// cut_along_crossings(), then of the patches between the lines only those with a winding number of
/// 0 before and 1 behind them. Cost O(patches x n).
/// @error repair.failed
[[nodiscard]] Result<mesh::TriMesh> resolve_crossings(const mesh::TriMesh& mesh);

}  // namespace decomp::repair
