// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/plane.h"

#include <optional>

namespace tests {

/// Volume below the plane by CGAL's Polygon_mesh_processing::clip; nothing when it refuses.
std::optional<double> clipped_volume(const decomp::mesh::TriMesh& mesh,
                                     const decomp::part::Plane& plane);

/// Volume of the common part of two closed meshes by CGAL's corefinement; nothing when it refuses.
std::optional<double> common_volume(const decomp::mesh::TriMesh& a, const decomp::mesh::TriMesh& b);

}  // namespace tests
