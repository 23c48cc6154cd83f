// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"
#include "cam/profile/read_profile.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <vector>

namespace cam::fdm {

/// Plans all beads of one part: walls, skins, infill, supports, brim. The skirt belongs to the
/// plate (merge_layers). The part is sliced in the middle of each layer; the first layer has its
/// own height and width. Cost: a few milliseconds a layer; parallel over layers, and the result
/// does not depend on the number of threads.
/// @param part_on_bed  closed, in PartBedFrame: base at z = 0
/// @param mating  for each triangle, whether another part touches it there: such faces get the gap
/// of the profile, the seams, and denser infill behind them; empty: none
/// @error fdm.open_mesh, fdm.empty (no layer meets material), run.cancelled
[[nodiscard]] decomp::Result<path::LayerStack> plan_part(const decomp::mesh::TriMesh& part_on_bed,
                                                         const std::vector<bool>& mating,
                                                         const profile::FdmSetup& setup,
                                                         const decomp::Run& run);
[[nodiscard]] decomp::Result<path::LayerStack> plan_part(const decomp::mesh::TriMesh& part_on_bed,
                                                         const profile::FdmSetup& setup,
                                                         const decomp::Run& run);

}  // namespace cam::fdm
