// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"
#include "cam/polygon/polygon.h"
#include "decomp/base/units.h"

#include <vector>

namespace cam::fdm {

/// Cuts walls where their share over air passes a quarter, a half and three quarters of their
/// width; from piece to piece the speed falls in even steps from the wall's own to `speed`. Those
/// over air by more than half become overhang walls. Stretches shorter than a millimetre go with
/// their neighbours. The pieces follow each other without a travel.
[[nodiscard]] std::vector<path::Bead> with_overhangs(std::vector<path::Bead> beads,
                                                     const polygon::Paths& below,
                                                     decomp::Speed speed);

}  // namespace cam::fdm
