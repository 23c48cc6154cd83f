// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

namespace decomp::repair {

/// A closed manifold around triangles of any kind: holes up to alpha_mm are bridged, the surface
/// lies offset_mm outside (Portaneri et al. 2022, alpha wrapping). Cost grows like 1 / alpha^2: 1 s
/// at 1/50 of the diagonal, 10 s at 1/200.
/// @error repair.failed
[[nodiscard]] Result<mesh::TriMesh> wrap(const mesh::TriMesh& soup, double alpha_mm,
                                         double offset_mm);

}  // namespace decomp::repair
