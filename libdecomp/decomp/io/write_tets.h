// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/tets/tet_mesh.h"

#include <span>
#include <string>

/// Tets as the bytes of a file; write_file() puts them on disk. Coordinates are the shortest
/// decimals that read back as the same double. Equal input gives equal bytes.
namespace decomp::io {

/// Medit .mesh. The boundary facets, in boundary order, become its triangles, with the given
/// references (one for each, or none: 0 for all).
[[nodiscard]] std::string medit_bytes(std::span<const Eigen::Vector3d> points,
                                      std::span<const tets::Tet> tets,
                                      std::span<const int> references);

/// Legacy VTK, ASCII, unstructured grid.
[[nodiscard]] std::string vtk_bytes(std::span<const Eigen::Vector3d> points,
                                    std::span<const tets::Tet> tets);

}  // namespace decomp::io
