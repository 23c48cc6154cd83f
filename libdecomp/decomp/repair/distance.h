// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

namespace decomp::repair {

/// The largest distance from sample points of one surface (its corners, and the centres of its
/// triangles) to the other, mm; 0 when either is empty. A lower bound of the one-sided Hausdorff
/// distance. O((n + m) log m).
[[nodiscard]] double farthest_mm(const mesh::TriMesh& from, const mesh::TriMesh& to);

}  // namespace decomp::repair
