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

/// The surface that a reader of a binary STL finds: coordinates rounded to float, points that
/// became equal welded, triangles that lost their area taken out together with their neighbours'
/// share, so that a closed surface stays closed. Edges where a pinched part touches itself come out
/// with four triangles.
[[nodiscard]] mesh::TriMesh float_mesh(const mesh::TriMesh& mesh);

}  // namespace decomp::cut
