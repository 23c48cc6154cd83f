// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Geometry>

namespace decomp::mesh {

/// Axis-aligned bounds of the points that triangles use; empty for a mesh without triangles. O(n).
[[nodiscard]] Eigen::AlignedBox3d bounds(const TriMesh& mesh);

/// Length of the diagonal of the bounds, mm; 0 for an empty mesh.
[[nodiscard]] double diagonal_mm(const TriMesh& mesh);

/// Signed volume, mm^3, positive for an outward oriented closed mesh (divergence theorem about the
/// centre of the bounds). O(n), compensated, in the order of the triangles.
[[nodiscard]] double volume_mm3(const TriMesh& mesh);

/// Surface area, mm^2.
[[nodiscard]] double area_mm2(const TriMesh& mesh);

/// Cross product of two edges: length is twice the area, direction is the outward normal.
[[nodiscard]] Eigen::Vector3d double_area_normal(const TriMesh& mesh, std::size_t triangle);

/// The mesh with every point p replaced by map * p. A reflection flips the triangles so that they
/// stay outward.
[[nodiscard]] TriMesh transformed(const TriMesh& mesh, const Eigen::Affine3d& map);

}  // namespace decomp::mesh
