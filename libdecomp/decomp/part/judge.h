// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/frame.h"
#include "decomp/part/part.h"

#include <functional>
#include <string>
#include <vector>

namespace decomp::part {

/// One constraint that a part misses: by_ratio is extent / limit, so 1.3 is 30 % too large. Always
/// above 1.
struct Violation {
    std::string constraint;  ///< e.g. "chamber.x"
    double by_ratio = 1;
};

/// What a machine says of a part (decision: a judge answers with more than yes or no).
struct Verdict {
    std::vector<Violation> violations;  ///< empty: the part can be made
    Pose<PartBedFrame, ModelFrame>
        best_pose;  ///< the pose in which the violations (or their absence) were found
    double support_area_mm2 = 0;        ///< surface that needs support in best_pose
    bool stable = true;                 ///< the centre of mass stands above the base in best_pose
    std::vector<Plane> cuts_that_help;  ///< where a cut would help most, best first; model frame

    [[nodiscard]] bool ok() const { return violations.empty(); }
};

/// Estimate: a few milliseconds, for searches. Exact: what the maker of the program will check.
enum class Fidelity { Estimate, Exact };

/// libcam supplies one, so libdecomp never learns libcam's name. Must be pure and callable from
/// several threads.
using Judge = std::function<Verdict(const Part&, Fidelity)>;

}  // namespace decomp::part
