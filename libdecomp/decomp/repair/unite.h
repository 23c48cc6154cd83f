// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstddef>

namespace decomp::repair {

struct UnitedShells {
    std::size_t groups = 0;      ///< sets of shells that cross each other
    std::size_t shells = 0;      ///< shells in them
    std::size_t subtracted = 0;  ///< of them, inward ones taken away from the others
    double shrunk_mm =
        0;  ///< largest shift of a shell that had to be shrunk to be united, see boolean.h
};

/// Replaces shells that cross each other by their exact union; inward shells that cross outward
/// ones are subtracted. In each group the shell of the largest volume is taken to face outward,
/// unless the whole group lies within another shell. The mesh is closed and manifold and no shell
/// crosses itself. Exact constructions, rounded once at the end. The mesh is unchanged when it
/// fails. @error repair.failed, run.cancelled
[[nodiscard]] Result<UnitedShells> unite_shells(mesh::TriMesh& mesh, const Run& run);

}  // namespace decomp::repair
