// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/solid/solid.h"

#include <optional>
#include <vector>

namespace decomp::solid {

struct BoundedCurve {
    Curve curve;
    double t0 = 0;
    double t1 = 0;
    double off_mm = 0;  ///< between the curve and its surfaces, at most
};

/// The curve in which two surfaces meet, along a path near it: from its first point to its last, in
/// its sense; all round where `closed`. Lines, circles and ellipses are known; nothing where the
/// surfaces meet in another curve, or not along this path. Of a cone: circles and ellipses, its
/// straight lines, and circles with what shares its axis; of a torus circles alone.
[[nodiscard]] std::optional<BoundedCurve> curve_along(const Surface& a, const Surface& b,
                                                      const std::vector<Eigen::Vector3d>& path,
                                                      bool closed);

}  // namespace decomp::solid
