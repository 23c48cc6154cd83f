// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace decomp::solid {

struct CircleFit {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double radius = 0;
};

/// The circle through three points; nothing where they lie on a line.
[[nodiscard]] std::optional<CircleFit> circle_through(const Eigen::Vector2d& a,
                                                      const Eigen::Vector2d& b,
                                                      const Eigen::Vector2d& c);

/// A line that the circle touches: normal . centre + side * radius = offset.
struct TangentLine {
    Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
    double side = 1;
    double offset = 0;
};

/// The circle of least squared distances, by Gauss-Newton from `start`, among those that touch
/// these lines (two at most, and not one line twice). At least three points.
[[nodiscard]] CircleFit fit_circle(const std::vector<Eigen::Vector2d>& points,
                                   const CircleFit& start,
                                   const std::vector<TangentLine>& touched = {});

}  // namespace decomp::solid
