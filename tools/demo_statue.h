// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

namespace tools {

/// A bust on a pedestal, 260 x 180 x 420 mm, z up, standing on z = 0: a closed manifold surface
/// without self-intersection. The same triangles every time.
/// @param cell_mm edge of the sampling grid; 5 gives about 70,000 triangles
[[nodiscard]] decomp::mesh::TriMesh demo_statue(double cell_mm);

}  // namespace tools
