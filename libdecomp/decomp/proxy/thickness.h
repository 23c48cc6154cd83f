// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <cstddef>

/// Inside the room: how thick the material is.
namespace decomp::proxy {

/// The length inward from the surface to where it is met again, mm: the value below which `share`
/// of the samples lie (0 to 1). Samples are spread evenly over the area. 0 when no ray meets the
/// surface again.
[[nodiscard]] double thickness_mm(const mesh::TriMesh& surface, double share, std::size_t samples);

}  // namespace decomp::proxy
