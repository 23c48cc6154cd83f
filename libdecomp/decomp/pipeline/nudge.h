// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/plane.h"

/// Inside the room: keeping planes away from vertices, so that parts survive rounding.
namespace decomp::pipeline {

/// The plane moved along its normal by 0, +-1 … +-4 steps: by the least of these at which no point
/// of the mesh is closer than half a step, or by the best of them. `turn` skips that many
/// acceptable positions, for another try.
[[nodiscard]] part::Plane nudged(const part::Plane& plane, const mesh::TriMesh& mesh,
                                 double step_mm, int turn = 0);

}  // namespace decomp::pipeline
