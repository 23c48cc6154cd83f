// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/fdm/bead_size.h"
#include "cam/fdm/infill.h"
#include "cam/fdm/skins.h"
#include "cam/fdm/support.h"
#include "cam/fdm/walls.h"
#include "cam/polygon/polygon.h"

#include <vector>

namespace cam::fdm {

/// One layer on its way from slice to beads: each step fills in one more field.
struct PartLayer {
    double top_mm = 0;
    BeadSize bead;
    polygon::Paths slice;
    polygon::Paths mating;  ///< lines where the slice touches another part
    Walls walls;
    std::vector<Line> outer_walls;  ///< closed, begun at their seams
    Interior interior;
    SupportAreas support;
};

}  // namespace cam::fdm
