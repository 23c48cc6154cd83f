// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <cstddef>

namespace decomp::mesh {

/// The combinatorial state of a mesh. Geometry (self-intersection) is the business of the room
/// `repair`.
struct TopologyReport {
    std::size_t border_edges = 0;        ///< edges with one triangle
    std::size_t non_manifold_edges = 0;  ///< edges with three triangles or more
    std::size_t misoriented_edges =
        0;  ///< edges with two triangles that run it in the same direction
    std::size_t non_manifold_vertices =
        0;                                 ///< vertices whose triangles form more than one umbrella
    std::size_t degenerate_triangles = 0;  ///< with a repeated index, or of no area
    std::size_t components = 0;            ///< by shared edges
    long euler_characteristic = 0;         ///< V - E + F over used vertices

    [[nodiscard]] bool closed() const { return border_edges == 0; }

    [[nodiscard]] bool manifold() const {
        return border_edges == 0 && non_manifold_edges == 0 && misoriented_edges == 0 &&
               non_manifold_vertices == 0;
    }
};

/// O(n log n), by sorting directed edges.
[[nodiscard]] TopologyReport check_topology(const TriMesh& mesh);

}  // namespace decomp::mesh
