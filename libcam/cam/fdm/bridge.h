// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"
#include "decomp/base/units.h"

#include <vector>

namespace cam::fdm {

/// A patch of a layer that hangs in the air between things to rest on, and the way its lines should
/// run.
struct BridgeArea {
    polygon::Paths area;  ///< with a strip on what it rests on
    decomp::Angle direction;
    polygon::Paths air;  ///< the part of it with nothing below
    double span_mm = 0;  ///< longest way over air of a line that rests at both ends
    bool rests = false;  ///< practically all lines do
};

/// Finds the patches of `inside` that have nothing of `below` under them and are wider than a bead,
/// each with the direction in which the least length of its lines lacks a rest at either end, then
/// with the shortest span.
[[nodiscard]] std::vector<BridgeArea> find_bridges(const polygon::Paths& inside,
                                                   const polygon::Paths& below, double spacing_mm);

}  // namespace cam::fdm
