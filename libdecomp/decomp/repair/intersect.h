// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace decomp::repair {

/// Pairs of triangles that meet elsewhere than in corners and edges which they share, or that
/// overlap in a plane; exact predicates. Corners count as shared when their coordinates are equal.
/// Triangles without area never count. Sorted; at most `at_most` pairs. O(n log n) for the boxes,
/// 0.1 s for 70 000 triangles.
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(
    const mesh::TriMesh& mesh, std::size_t at_most);

}  // namespace decomp::repair
