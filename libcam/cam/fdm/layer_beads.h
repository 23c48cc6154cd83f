// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/fdm/part_layer.h"
#include "cam/path/layers.h"
#include "cam/profile/fdm_machine.h"

#include <cstddef>
#include <vector>

namespace cam::fdm {

/// The beads of one layer in printing order: brim (first layer only, outermost first), support,
/// then the part island by island.
/// @param index  of the layer, from 0; decides on angles and on first-layer speed
/// @param below  the layer below, null under the first: walls over air are slowed, solid areas over
/// sparse infill are bridges
[[nodiscard]] std::vector<path::Bead> make_beads(const PartLayer& layer, std::size_t index,
                                                 const PartLayer* below,
                                                 const profile::FdmMachine& machine);

}  // namespace cam::fdm
