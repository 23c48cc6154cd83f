// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/run.h"
#include "decomp/solid/regions.h"

namespace decomp::solid {

/// The triangles of a mesh after points were taken out; numbers of points and triangles are those
/// of the mesh.
struct Collapsed {
    std::vector<mesh::Triangle> triangles;
    std::vector<bool> alive;
    std::size_t removed_points = 0;
};

/// Collapses edges onto one of their ends by rising quadric error until `max_faces` faces are left.
/// Every removed point stays within `watched_mm` of the triangles that took its place.
/// @error run.cancelled
[[nodiscard]] Result<Collapsed> collapse(const part::Part& part, const Adjacency& adjacency,
                                         const Regions& regions, double watched_mm,
                                         std::size_t max_faces, const Run& run);

}  // namespace decomp::solid
