// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <vector>

namespace decomp::repair {

struct BooleanResult {
    mesh::TriMesh mesh;
    double shrunk_mm =
        0;  ///< largest shift of an operand that had to be shrunk, 0 where all stayed exact
};

/// The union of `added`, less the union of `removed`. Each is closed, outward and free of
/// self-intersection. Corefinement with exact constructions throughout; coordinates are rounded to
/// double once, at the end. Where a union would touch itself in an edge or a point only, which no
/// manifold can, the later operand is shrunk by 1e-6 of its extent, then 1e-5 and 1e-4. @error
/// repair.failed  when that does not help, or an operand crosses itself; run.cancelled
[[nodiscard]] Result<BooleanResult> exact_boolean(const std::vector<mesh::TriMesh>& added,
                                                  const std::vector<mesh::TriMesh>& removed,
                                                  const Run& run);

}  // namespace decomp::repair
