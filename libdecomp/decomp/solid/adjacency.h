// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstdint>
#include <vector>

namespace decomp::solid {

/// Half-edge 3 t + k runs from corner k of triangle t to its next corner.
struct Adjacency {
    std::vector<std::uint32_t> twin;  ///< for each half-edge the one that runs the other way

    [[nodiscard]] static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
};

[[nodiscard]] inline std::uint32_t start_of(const mesh::TriMesh& mesh, std::uint32_t h) {
    return mesh.triangles[h / 3][h % 3];
}

[[nodiscard]] inline std::uint32_t end_of(const mesh::TriMesh& mesh, std::uint32_t h) {
    return mesh.triangles[h / 3][(h + 1) % 3 == 0 ? 0 : h % 3 + 1];
}

/// @error solid.not_closed an edge has not exactly two triangles, of opposite sense. O(n log n)
[[nodiscard]] Result<Adjacency> adjacency_of(const mesh::TriMesh& mesh);

}  // namespace decomp::solid
