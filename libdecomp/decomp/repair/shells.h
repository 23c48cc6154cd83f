// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <cstddef>
#include <vector>

namespace decomp::repair {

/// The sum of solid angles of all triangles seen from a point, over 4 pi: 1 inside an outward
/// closed surface, 0 outside.
[[nodiscard]] double winding_number(const mesh::TriMesh& mesh, const Eigen::Vector3d& point);

/// What sorting closed shells by nesting changed.
struct ShellReport {
    std::size_t shells = 0;  ///< left in the mesh
    std::size_t voids = 0;   ///< of them, cavities
    std::size_t turned =
        0;  ///< shells turned inside out because the outermost around them faced inward
    std::size_t alternated = 0;  ///< shells turned because senses meant nothing
    std::size_t dropped = 0;     ///< shells dropped: solid within solid, or a cavity within nothing
    double dropped_volume_mm3 = 0;  ///< of the dropped shells, each counted positive
};

/// Orients and thins closed shells that do not cross each other, as repair() documents. With
/// trust_senses false nested shells alternate between solid and cavity. The mesh keeps its points
/// where nothing is dropped.
[[nodiscard]] ShellReport arrange_shells(mesh::TriMesh& mesh, bool trust_senses);

}  // namespace decomp::repair
