// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/layout.h"

/// Inside the room: labellings that look valid at every place and yet belong to no polycube.
namespace decomp::labels {

/// True only when no polycube has these charts, whatever its measures. Each boundary is a convex or
/// a concave edge of the polycube. Where three meet, the order of the labels around the corner
/// tells whether all three bend alike (the labels' axes turn as those of a convex corner do) or
/// not; around a side with four corners every turn is to the left, which tells how neighbouring
/// edges bend; and around any side the turns to the left outnumber those to the right by four times
/// its Euler characteristic. The labelling is impossible when these statements contradict each
/// other: for one, when it is a box inside out. False also for labellings that are not locally
/// valid. O(facets).
[[nodiscard]] bool impossible(const Facets& facets, const Layout& layout);

}  // namespace decomp::labels
