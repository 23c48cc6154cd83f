// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstddef>

namespace decomp::repair {

struct FilledHoles {
    std::size_t holes = 0;
    std::size_t triangles = 0;
    double area_mm2 = 0;  ///< of the new triangles
};

/// Closes every border loop of an oriented manifold by triangles over its points (minimal dihedral
/// angle, then area: Liepa 2003). The mesh is unchanged when it fails. @error repair.failed
[[nodiscard]] Result<FilledHoles> fill_holes(mesh::TriMesh& mesh);

/// Removes triangles whose corners lie in a line by flips and collapses. Returns how many there
/// were. The mesh is unchanged when it fails. @error repair.failed
[[nodiscard]] Result<std::size_t> remove_slivers(mesh::TriMesh& mesh);

}  // namespace decomp::repair
