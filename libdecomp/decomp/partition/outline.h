// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/plane.h"

/// Inside the room: the cross-section of a mesh in doubles.
namespace decomp::partition {

struct Outline {
    double area_mm2 = 0;
    int curves = 0;  ///< closed curves, holes included
};

/// One pass over the triangles.
[[nodiscard]] Outline outline_of(const mesh::TriMesh& mesh, const part::Plane& plane);

}  // namespace decomp::partition
