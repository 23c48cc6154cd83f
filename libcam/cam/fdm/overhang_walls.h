// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"
#include "cam/polygon/polygon.h"
#include "decomp/base/units.h"

#include <vector>

namespace cam::fdm {

/// Cuts walls where they leave what lies below and come back to it; the stretches in between, over
/// air by more than half their width, become overhang walls of their own speed. Stretches shorter
/// than a millimetre stay as they are. The pieces follow each other without a travel.
[[nodiscard]] std::vector<path::Bead> with_overhangs(std::vector<path::Bead> beads,
                                                     const polygon::Paths& below,
                                                     decomp::Speed speed);

}  // namespace cam::fdm
