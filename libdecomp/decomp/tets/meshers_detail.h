// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/tets/tet_mesh.h"

namespace decomp::tets {

/// Tets as gmsh's Delaunay mesher gives them, unchecked. The surface's points come first, in order.
/// Equal surfaces give equal tets.
/// @error tets.no_mesher, tets.failed
[[nodiscard]] Result<TetMesh> gmsh_tets(const mesh::TriMesh& surface);

/// Tets as CGAL's Mesh_3 gives them, unchecked. @error tets.failed
[[nodiscard]] Result<TetMesh> mesh3_tets(const mesh::TriMesh& surface, double edge_mm);

}  // namespace decomp::tets
