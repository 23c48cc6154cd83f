// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"

#include <Eigen/Core>

namespace cam::profile {

/// Where the parts of a plate may lie, brims and supports included: the chamber less its margin,
/// and less the room that a skirt takes. Machine coordinates.
struct BedArea {
    Eigen::Vector2d min_mm = Eigen::Vector2d::Zero();
    Eigen::Vector2d max_mm = Eigen::Vector2d::Zero();
    double height_mm = 0;  ///< of the tallest part

    [[nodiscard]] Eigen::Vector2d size_mm() const { return max_mm - min_mm; }
};

/// From the outline of the parts to the outer edge of the skirt; 0 when the process has a brim or
/// no skirt.
[[nodiscard]] double skirt_reach_mm(const FdmMachine::Process& process);

[[nodiscard]] BedArea bed_area(const FdmMachine& machine);

}  // namespace cam::profile
