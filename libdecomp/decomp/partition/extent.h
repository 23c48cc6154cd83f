// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cells/cells.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace decomp::partition {

/// The box that a part takes up in polycube space.
struct Extent {
    std::vector<char> cells;  ///< for each cell: whether the part is made of it
    Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< polycube space
    Eigen::Vector3d high = Eigen::Vector3d::Zero();
};

/// The extent of those sub-tets whose centres lie in the part and whose cells make up 95 % of it,
/// largest first: what strays into the part from other boxes does not stretch its own. Nothing when
/// no unflipped sub-tet lies in the part. O(sub-tets * facets of a column).
[[nodiscard]] std::optional<Extent> extent_of(const cells::CellComplex& cells,
                                              const mesh::TriMesh& part);

}  // namespace decomp::partition
