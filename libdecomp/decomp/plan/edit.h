// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/part/plane.h"

#include <string>
#include <string_view>
#include <vector>

namespace decomp::plan {

/// A change that a person wants made to the parts.
struct Edit {
    enum class Kind {
        Split,  ///< a part at a share of its extent along an axis
        Merge,  ///< parts into one
        Plane,  ///< every part that the plane meets
    };
    Kind kind = Kind::Split;
    std::vector<std::string> parts;  ///< one to split, two or more to merge
    int axis = 0;                    ///< of a split: 0 x, 1 y, 2 z
    double share = 0.5;              ///< of a split: above 0, below 1
    part::Plane plane;               ///< unit normal
    std::string text;                ///< as parse_edit() reads it
};

/// "split P03:z=0.5", "merge P02+P05" or "plane 0 0 1 50": the normal, of any length, and the
/// distance from the origin along it in mm. @error plan.edit
[[nodiscard]] Result<Edit> parse_edit(std::string_view text);

}  // namespace decomp::plan
