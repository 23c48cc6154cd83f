// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

/// Plane regions on an integer grid of one nanometre: what is computed twice is equal twice.
namespace cam::polygon {

/// A point in nanometres.
struct Point {
    std::int64_t x = 0;
    std::int64_t y = 0;

    bool operator==(const Point&) const = default;
};

/// A closed loop (its first point not repeated) or an open line, as the function that takes it
/// says.
using Path = std::vector<Point>;
using Paths = std::vector<Path>;

/// A bounding box; empty when min.x > max.x.
struct Box {
    Point min{1, 1};
    Point max{0, 0};

    [[nodiscard]] bool empty() const { return min.x > max.x; }
};

/// An outer loop with the holes directly inside it.
struct Island {
    Path outer;
    Paths holes;

    /// All loops, outer first.
    [[nodiscard]] Paths loops() const;
};

/// Nearest grid point, half away from zero.
[[nodiscard]] Point from_mm(const Eigen::Vector2d& point_mm);
[[nodiscard]] std::int64_t nanometres(double length_mm);
[[nodiscard]] Eigen::Vector2d to_mm(const Point& point);
[[nodiscard]] double to_mm(std::int64_t length);

/// Signed area, mm^2: positive for counter-clockwise loops.
[[nodiscard]] double area_mm2(const Path& loop);

/// Sum of the signed areas: the area of a region.
[[nodiscard]] double area_mm2(const Paths& region);

/// Length of a loop, closing edge included, mm.
[[nodiscard]] double perimeter_mm(const Path& loop);

[[nodiscard]] Box bounds(const Path& path);
[[nodiscard]] Box bounds(const Paths& paths);

/// Whether two boxes share a point after both have grown by half of `reach`.
[[nodiscard]] bool touches(const Box& a, const Box& b, std::int64_t reach = 0);

/// Whether the point is inside the region or on its boundary (even-odd). O(n).
[[nodiscard]] bool contains(const Paths& region, const Point& point);

/// The outer loops of a region with their holes, in the order of the outer loops. O(n^2) in loops
/// at worst, with a bounding box test.
[[nodiscard]] std::vector<Island> islands(const Paths& region);

/// The loop with points left out such that none of them lies further than `tolerance_mm` from the
/// new loop (Douglas-Peucker between two extreme points). Loops of no area vanish.
[[nodiscard]] Path simplified(const Path& loop, double tolerance_mm);

/// Each loop simplified by itself.
[[nodiscard]] Paths simplified(const Paths& region, double tolerance_mm);

/// The convex hull of all points, counter-clockwise.
[[nodiscard]] Path convex_hull(const Paths& paths);

/// The loops moved.
[[nodiscard]] Paths translated(const Paths& paths, const Point& by);

}  // namespace cam::polygon
