// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"
#include "decomp/base/result.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace cam::plate {

/// What a part takes on the bed.
struct Footprint {
    std::string id;
    std::vector<Eigen::Vector2d>
        outline;  ///< convex hull of everything that is printed, brim included; PartBedFrame
    double height_mm = 0;
};

struct Placement {
    std::size_t part = 0;
    int plate = 0;  ///< from 0
    Eigen::Vector2d offset =
        Eigen::Vector2d::Zero();  ///< from PartBedFrame to the machine's coordinates
};

/// Arranges parts on as few plates as it can find; parts are not turned. Parts stay
/// `part_spacing_mm` apart (up to a thousandth) and inside profile::bed_area(); each plate is
/// centred on the bed. Deterministic, serial. Cost about O(p^3) for the p parts of one plate,
/// milliseconds for ten.
/// @return one placement for each part, in the order of the parts
/// @error plate.part_too_large
[[nodiscard]] decomp::Result<std::vector<Placement>> pack(const std::vector<Footprint>& parts,
                                                          const profile::FdmMachine& machine);

}  // namespace cam::plate
