// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/tets/tet_mesh.h"

namespace decomp::tets {

/// Fills a closed surface with tets and keeps its triangles: points [0, surface.points.size()) are
/// the surface's, in order; the boundary facets are its triangles. All tets are positive. By gmsh's
/// Delaunay mesher, loaded when first needed, in a forked copy of the process; calls queue up. The
/// answer is checked before it is believed. Equal surfaces give equal tets.
/// @error tets.bad_surface  not closed, or no volume
/// @error tets.no_mesher    gmsh is not installed
/// @error tets.failed       the surface was not filled (mostly: it intersects itself, or has a
/// cavity, which this mesher overlooks)
/// Cost: about 0.3 s for 4 000 triangles.
[[nodiscard]] Result<TetMesh> tetrahedralise(const mesh::TriMesh& surface, Run& run);

/// Fills a closed surface with tets whose boundary is sampled anew (CGAL Mesh_3, which bears near
/// and small self-intersections): the way out where tetrahedralise() fails. Cavities stay empty.
/// All tets are positive.
/// @param edge_mm  length of the boundary's edges
/// @error tets.bad_surface, tets.failed
/// Cost: about 0.4 s for 10 000 tets.
[[nodiscard]] Result<TetMesh> tetrahedralise_anew(const mesh::TriMesh& surface, double edge_mm,
                                                  Run& run);

}  // namespace decomp::tets
