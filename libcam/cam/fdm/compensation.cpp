// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/compensation.h"

#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"

#include <algorithm>
#include <numbers>

namespace cam::fdm {

namespace {

using polygon::Path;
using polygon::Paths;

/// The loop as an outline of its own.
Path turned(Path loop) {
    std::reverse(loop.begin(), loop.end());
    return loop;
}

Paths with_sizes(const Paths& slice, const Compensation& by) {
    Paths outers;
    Paths round;
    Paths others;
    for (const Path& loop : slice) {
        if (polygon::area_mm2(loop) > 0) {
            outers.push_back(loop);
        } else {
            (is_round_hole(loop) ? round : others).push_back(turned(loop));
        }
    }
    const bool holes = by.hole_growth_mm != 0 && !round.empty();
    if (by.outline_inset_mm == 0 && !holes) {
        return slice;
    }
    // Outlines inside holes are islands of their own: each is drawn in by itself.
    Paths out;
    for (const polygon::Island& island : polygon::islands(slice)) {
        Paths piece = polygon::offset({island.outer}, -by.outline_inset_mm);
        for (const Path& hole : island.holes) {
            const Paths open = is_round_hole(hole)
                                   ? polygon::offset({turned(hole)}, by.hole_growth_mm)
                                   : Paths{turned(hole)};
            piece = polygon::subtract(piece, open);
        }
        out.insert(out.end(), piece.begin(), piece.end());
    }
    return polygon::region_of(out);
}

}  // namespace

bool is_round_hole(const Path& loop) {
    const double area = -polygon::area_mm2(loop);
    const double around = polygon::perimeter_mm(loop);
    return area > 0 && around < std::numbers::pi * kLargestHoleMm &&
           4 * std::numbers::pi * area >= kRound * around * around;
}

Paths compensated(const Paths& slice, const Paths& mating, const Compensation& by) {
    Paths out = with_sizes(slice, by);
    if (by.mating_inset_mm > 0 && !mating.empty()) {
        out = polygon::subtract(out, polygon::thickened(mating, by.mating_inset_mm));
    }
    return out;
}

Paths foot_drawn_in(const Paths& slice, const Paths& above, const Compensation& by) {
    if (by.foot_inset_mm <= 0) {
        return slice;
    }
    const double half = by.least_width_mm / 2;
    const Paths broad = polygon::offset(polygon::offset(slice, -half), half);
    const Paths narrow = polygon::subtract(slice, polygon::offset(broad, by.foot_inset_mm / 2));
    //   layer 2  ______________|    A countersink, a fillet: what spreads lies under the shelf, and
    //   layer 1  __________|        a foot drawn in would take away what carries the shelf's wall.
    const Paths shelf = polygon::opened(polygon::subtract(above, slice), by.foot_inset_mm / 2);
    const Paths under = polygon::intersect(slice, polygon::offset(shelf, 2 * by.foot_inset_mm));
    return polygon::unite(polygon::unite(polygon::offset(slice, -by.foot_inset_mm), narrow), under);
}

}  // namespace cam::fdm
