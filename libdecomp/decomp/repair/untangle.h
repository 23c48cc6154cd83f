// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

namespace decomp::repair {

/// Re-triangulates the neighbourhoods of the triangles of a closed manifold that cross each other.
/// Local, so fit for few crossings only; the caller checks the result. The mesh is unchanged when
/// it fails. @error repair.failed
[[nodiscard]] decomp::Status untangle(mesh::TriMesh& mesh);

}  // namespace decomp::repair
