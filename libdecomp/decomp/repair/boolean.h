// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <vector>

namespace decomp::repair {

/// The union of `added`, less the union of `removed`. Each is closed, outward and free of
/// self-intersection. Corefinement with exact constructions throughout; coordinates are rounded to
/// double once, at the end.
/// @error repair.failed  where the result would touch itself in an edge or a point, or an operand
/// crosses itself
[[nodiscard]] Result<mesh::TriMesh> exact_boolean(const std::vector<mesh::TriMesh>& added,
                                                  const std::vector<mesh::TriMesh>& removed,
                                                  const Run& run);

}  // namespace decomp::repair
