// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/part/part.h"

namespace decomp::sections {

/// How thickly two parts hang together: the diameter of the largest circle within each connected
/// piece of their interface, and of these the least; mm, to 1 %. 0 for an interface without area.
/// Cost O(edges of the rim) for each of a few hundred points.
[[nodiscard]] double interface_neck_mm(const part::Assembly& assembly,
                                       const part::Interface& interface);

}  // namespace decomp::sections
