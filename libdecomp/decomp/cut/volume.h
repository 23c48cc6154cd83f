// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cut/cells.h"

#include <string>
#include <vector>

namespace decomp::cut {

/// Signed volume in mm^3 of closed, outward oriented sides, from rounded coordinates; good to about
/// 1e-13 relative.
[[nodiscard]] double approximate_volume(const Cells& cells, const std::vector<FaceSide>& sides);

/// Sign of the exact volume.
[[nodiscard]] int volume_sign(const Cells& cells, const std::vector<FaceSide>& sides);

/// The exact volume in mm^3 as "numerator/denominator" in lowest terms.
[[nodiscard]] std::string exact_volume(const Cells& cells, const std::vector<FaceSide>& sides);

/// True when the faces in every input triangle tile it exactly and every other face separates two
/// regions: then the volumes of the regions sum to the volume of the input, as rationals.
[[nodiscard]] bool tiles_input_exactly(const Cells& cells);

}  // namespace decomp::cut
