// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/tool/tool.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace cam::profile {

/// A mill with three linear axes, with or without a rotary axis A along X. Read from
/// machine_profiles/mill/NAME.toml.
struct MillMachine {
    std::string name;                ///< the file's stem
    std::string title;               ///< for people
    std::vector<std::string> tools;  ///< machine_profiles/tools/NAME.toml, in the order of use

    /// Where the spindle's nose may be.
    struct Travel {
        Eigen::Vector3d min_mm = Eigen::Vector3d::Zero();
        Eigen::Vector3d max_mm = Eigen::Vector3d::Zero();
        double nose_to_table_mm = 0;  ///< spindle nose at the top of its travel, down to the table
        double margin_mm = 0;         ///< kept free at each side in X and Y, and at the top
    } travel;

    /// The rotary axis; absent while max_diameter_mm is 0.
    struct Rotary {
        double max_diameter_mm = 0;  ///< what can turn without touching table or frame
        double max_length_mm = 0;    ///< between chuck and tailstock
        double nose_to_axis_mm = 0;  ///< spindle nose at the top of its travel, down to the axis
        int a_sign = 1;              ///< +1: LinuxCNC, ISO 841; see docs/frames.md
    } rotary;

    /// How reach is judged.
    struct Reach {
        double tolerance_mm = 0.1;         ///< rest along the normal that counts as reached
        double cell_mm = 0.1;              ///< of the height maps
        double shank_clearance_mm = 0.1;   ///< kept between shank and part
        double holder_clearance_mm = 1;    ///< kept between holder and part
        double max_unreached_percent = 1;  ///< of a part's area, for a part that can be made
        int angles = 40;                   ///< of A that are tried, evenly over a turn
    } reach;

    [[nodiscard]] bool has_rotary() const { return rotary.max_diameter_mm > 0; }
};

}  // namespace cam::profile
