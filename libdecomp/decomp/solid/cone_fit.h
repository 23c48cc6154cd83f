// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/solid/solid.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace decomp::solid {

/// A cone about an axis: cos(half_angle) * radius - sin(half_angle) * height = offset_mm for its
/// points, by their distance from the axis and their height over `centre`. Fit for cones so slender
/// that their apex is far away.
struct ConeFit {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< on the axis
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();   ///< from the apex into the cone
    double half_angle = 0;                             ///< radians
    double offset_mm = 0;

    [[nodiscard]] double distance_mm(const Eigen::Vector3d& p) const;
    [[nodiscard]] ConeSurface surface() const;
};

/// What the cone has to keep to exactly.
struct ConeLimits {
    bool fixed_direction = false;  ///< of the axis
    bool fixed_centre = false;
    std::vector<PlaneSurface> along;    ///< contain the axis
    std::vector<PlaneSurface> touched;  ///< touch the cone along a line
    double side = 1;                    ///< of these: 1 where their normal leaves the cone
};

/// The cone that three planes at least touch, from inside or outside: its half angle is that of the
/// planes. Nothing where they touch no cone, or a cylinder.
[[nodiscard]] std::optional<ConeFit> cone_inside(const std::vector<PlaneSurface>& planes,
                                                 const Eigen::Vector3d& middle);

/// The cone of least squared distances, by so many rounds of Gauss-Newton from `start`. Of limits
/// that contradict each other only the first are kept.
[[nodiscard]] ConeFit fit_cone(const std::vector<Eigen::Vector3d>& points, const ConeFit& start,
                               const ConeLimits& limits = {}, int rounds = 12);

}  // namespace decomp::solid
