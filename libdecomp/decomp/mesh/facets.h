// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace decomp::mesh {

/// What most measures of a surface need of its triangles, one entry each.
struct Facets {
    std::vector<Eigen::Vector3d> unit;    ///< outward normal; zero for a triangle without area
    std::vector<Eigen::Vector3d> centre;  ///< barycentre
    std::vector<double> area_mm2;
    double total_mm2 = 0;  ///< summed in the order of the triangles
};

/// O(n).
[[nodiscard]] Facets measure_facets(const TriMesh& mesh);

/// For each triangle the one beyond each of its edges (corner i to corner i + 1), or -1 at a
/// border. Where more than two meet at an edge they are paired in the order of the triangles.
/// O(n log n).
[[nodiscard]] std::vector<std::array<std::int32_t, 3>> neighbours(const TriMesh& mesh);

}  // namespace decomp::mesh
