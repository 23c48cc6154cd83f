// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace decomp::part {

/// The oriented plane normal . x = offset_mm. The four doubles are exact by definition; the normal
/// need not be of unit length, only close to it, so that offset_mm reads as a distance.
struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    double offset_mm = 0;
};

}  // namespace decomp::part
