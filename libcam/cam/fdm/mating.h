// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstdint>
#include <vector>

namespace cam::fdm {

/// Where horizontal planes meet the facets on which a part touches another one: lines of two
/// points, per height. Facets that lie in a plane give none. O(mating facets * heights they cross).
/// @param mating   one flag a triangle, or empty: none
/// @param heights  nm, ascending
[[nodiscard]] std::vector<polygon::Paths> mating_lines(const decomp::mesh::TriMesh& mesh,
                                                       const std::vector<bool>& mating,
                                                       const std::vector<std::int64_t>& heights);

}  // namespace cam::fdm
