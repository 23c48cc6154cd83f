// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <cstdint>
#include <vector>

namespace decomp::io {

/// A volume mesh over shared points: four corners a tetrahedron, eight a hexahedron (bottom ring,
/// top ring).
struct Cells {
    std::vector<std::uint32_t> tetrahedra;
    std::vector<std::uint32_t> hexahedra;
};

/// The faces that belong to one cell only, outward, over the points of `mesh`. Where the corners of
/// neighbouring cells are listed in one sense throughout, that sense orients the whole boundary,
/// whatever single inverted cells do; otherwise every face turns away from its own cell. A quad is
/// cut along the diagonal of its lowest corner.
[[nodiscard]] mesh::TriMesh boundary_of(const Cells& cells, mesh::TriMesh mesh);

}  // namespace decomp::io
