// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstdint>
#include <vector>

namespace cam::fdm {

/// Points of a slice nearer than this to a straight line between others are left out, mm.
inline constexpr double kSliceToleranceMm = 0.002;

/// The sections of a closed mesh with horizontal planes at the given heights (nanometres,
/// ascending): one region per height. Vertices count as above a plane when z >= height, so no plane
/// ever passes through a vertex, and loops are closed by following the mesh from triangle to
/// triangle, not by searching for near points. Cost: O(triangles + crossings log). Parallel over
/// heights.
/// @error fdm.open_mesh (an edge has no partner that runs the other way), run.cancelled
[[nodiscard]] decomp::Result<std::vector<polygon::Paths>> slice(
    const decomp::mesh::TriMesh& mesh, const std::vector<std::int64_t>& heights,
    const decomp::Run& run);

}  // namespace cam::fdm
