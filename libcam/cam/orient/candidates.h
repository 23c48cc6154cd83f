// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/part/part.h"

#include <Eigen/Core>

#include <vector>

/// What a part could stand on.
namespace cam::orient {

/// A plane that touches the part's hull from below when `down` points to the plate.
struct Stand {
    Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();  ///< outward normal of the base, unit length
    int plane = -1;                                    ///< cut plane, or -1
    bool on_cut_face = false;
    bool on_flat = false;
};

/// Which stands to look for. Flats of the input cost as much to find as all else.
enum class Flats { Sought, Left };

/// Cut faces on the hull, then large flats of the input on it; the ends of the model axes when
/// there is neither, and for an uncut part in any case. With Flats::Left only the cut faces, if
/// any.
[[nodiscard]] std::vector<Stand> stands(const decomp::part::Part& part, Flats flats);

}  // namespace cam::orient
