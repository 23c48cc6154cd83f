// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/check.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace decomp::cut {

/// What is wrong with a part as written; all zero and empty for a sound one.
struct WrittenReport {
    mesh::TopologyReport topology;
    bool outward = true;  ///< the volume is positive
    std::vector<std::pair<std::uint32_t, std::uint32_t>>
        intersections;  ///< of triangles, at most the number asked for

    [[nodiscard]] bool sound() const {
        return topology.manifold() && outward && intersections.empty();
    }
};

/// Checks a mesh as it is: closed, manifold, outward, no two triangles that meet elsewhere than in
/// common points and edges. Points with equal coordinates count as one for the last. Exact
/// predicates; O(n log n).
[[nodiscard]] WrittenReport check_written(const mesh::TriMesh& mesh,
                                          std::size_t intersections_at_most = 1);

/// For each point the lowest index with the same coordinates. O(n log n).
[[nodiscard]] std::vector<std::uint32_t> first_of_equal(const std::vector<Eigen::Vector3d>& points);

/// The surface that a reader of a binary STL finds, and where its triangles come from.
struct FloatMesh {
    mesh::TriMesh mesh;
    std::vector<std::uint32_t>
        origin;  ///< of each triangle: the one that it was, or was flipped from
};

/// Coordinates rounded to float, equal points welded, triangles that lost a corner dropped, pairs
/// that became each other's back taken out, and triangles without area dissolved by flipping their
/// longest edge, so that a closed surface stays closed. An edge where a pinched part touches itself
/// comes out with four triangles. Write this, not the part, to an STL.
[[nodiscard]] FloatMesh float_mesh(const mesh::TriMesh& mesh);

}  // namespace decomp::cut
