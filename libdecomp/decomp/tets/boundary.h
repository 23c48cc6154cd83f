// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"
#include "decomp/tets/tet_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace decomp::tets {

/// The corners of face k of a tet, the one opposite its corner k: counter-clockwise seen from
/// outside when the tet is positive.
[[nodiscard]] mesh::Triangle face_of(const Tet& tet, std::size_t k);

/// A face that belongs to one tet only.
struct BoundaryFacet {
    mesh::Triangle corners{};  ///< outward when the tet is positive
    std::uint32_t tet = 0;
};

/// The boundary of a set of tets, by rising tet, then face: the *boundary order* in which labels of
/// a pair are listed. O(n log n).
[[nodiscard]] std::vector<BoundaryFacet> boundary_of(std::span<const Tet> tets);

/// For each tet and face k the tet on the other side, or -1. O(n log n).
[[nodiscard]] std::vector<std::array<std::int32_t, 4>> neighbours_of(std::span<const Tet> tets);

/// The boundary as a mesh over the points it uses, in boundary order; `points_from[i]` is the
/// index in `points` of the mesh's point i (rising).
struct BoundarySurface {
    mesh::TriMesh surface;
    std::vector<std::uint32_t> points_from;
};

[[nodiscard]] BoundarySurface boundary_surface(std::span<const Eigen::Vector3d> points,
                                               std::span<const Tet> tets);

}  // namespace decomp::tets
