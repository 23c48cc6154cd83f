// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/bed_area.h"

namespace cam::profile {

double skirt_reach_mm(const FdmMachine::Process& process) {
    if (process.brim_width_mm > 0 || process.skirt_loops == 0) {
        return 0;
    }
    return process.skirt_distance_mm + process.skirt_loops * process.first_layer_line_width_mm;
}

BedArea bed_area(const FdmMachine& machine) {
    const FdmMachine::Chamber& chamber = machine.chamber;
    const Eigen::Vector2d free =
        Eigen::Vector2d::Constant(chamber.margin_mm + skirt_reach_mm(machine.process));
    return {chamber.min_mm.head<2>() + free, chamber.max_mm.head<2>() - free,
            chamber.max_mm.z() - chamber.min_mm.z() - chamber.margin_mm};
}

}  // namespace cam::profile
