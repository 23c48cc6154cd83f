// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <cstddef>
#include <vector>

/// Inside the room: how thick the material is.
namespace decomp::proxy {

/// The length inward from the surface to where it is met again, mm: the value below which `share`
/// of the samples lie (0 to 1). Samples are spread evenly over the area. 0 when no ray meets the
/// surface again.
[[nodiscard]] double thickness_mm(const mesh::TriMesh& surface, double share, std::size_t samples);

/// For each triangle how wide the tunnel is that it lines, mm: the length outward to a facet that
/// faces back at it; infinity where there is none. Only every `stride`-th triangle is looked at.
[[nodiscard]] std::vector<double> tunnel_widths_mm(const mesh::TriMesh& surface,
                                                   std::size_t stride);

}  // namespace decomp::proxy
