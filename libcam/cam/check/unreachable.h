// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstddef>
#include <vector>

namespace cam::check {

/// A part without what no tool can reach.
struct Dropped {
    decomp::mesh::TriMesh mesh;
    std::size_t facets = 0;        ///< taken away
    double area_mm2 = 0;           ///< of them
    std::size_t patches = 0;       ///< closed: one hole each
    std::size_t cavities = 0;      ///< shells that were wholly unseen: filled
    std::size_t patches_left = 0;  ///< where they were: see below
    double area_left_mm2 = 0;
    double volume_before_mm3 = 0;
    double volume_after_mm3 = 0;
};

/// Takes away connected patches of unwanted facets and closes each hole (the paper, 7.3). Specks of
/// wanted facets that a patch surrounds go with it, and so do those around points in which patches
/// meet. A patch with more than one border would leave
/// the part in pieces, or open; it is left where it is, and so is one whose closed hole would cut
/// into the part. The result is closed, manifold and free of self-intersection where the part was.
/// @param wanted  for each triangle
/// @error check.drop_failed (no way to close the holes was found), run.cancelled
[[nodiscard]] decomp::Result<Dropped> drop_unreachable(const decomp::mesh::TriMesh& mesh,
                                                       const std::vector<char>& wanted,
                                                       const decomp::Run& run);

}  // namespace cam::check
