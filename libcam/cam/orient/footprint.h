// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <vector>

/// Inside the room: shadows on the plate and the rectangles around them.
namespace cam::orient {

/// Convex hull, counter-clockwise, no three points in line. O(n log h) in practice: points inside
/// the octagon of extremes are dropped first.
[[nodiscard]] std::vector<Eigen::Vector2d> convex_hull(const std::vector<Eigen::Vector2d>& points);

[[nodiscard]] double polygon_area(const std::vector<Eigen::Vector2d>& polygon);

/// True when a convex polygon holds the point.
[[nodiscard]] bool holds(const std::vector<Eigen::Vector2d>& hull, const Eigen::Vector2d& point);

/// A hull turned by -angle fits a rectangle of this size.
struct Turned {
    double angle = 0;  ///< radians
    Eigen::Vector2d size = Eigen::Vector2d::Zero();
    double ratio = 0;  ///< max of size / room

    [[nodiscard]] bool fits() const { return ratio <= 1; }
};

/// The best turn of a hull in a room: the smallest rectangle that fits, unturned if that is within
/// 2 % of it; when none fits, the least ratio. Exact: looks at every angle at which an edge is
/// parallel to a side, and between them where both ratios are equal. O(h log h).
[[nodiscard]] Turned best_turn(const std::vector<Eigen::Vector2d>& hull,
                               const Eigen::Vector2d& room);

}  // namespace cam::orient
