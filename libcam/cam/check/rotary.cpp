// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/rotary.h"

#include "cam/orient/footprint.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cam::check {

namespace {

constexpr double kInside = 1e-9;   // relative: a point so little outside a circle is in it
constexpr double kUpright = 0.99;  // cosine: an axis so steep has no up across it
constexpr double kFlatTriangle = 1e-12;

struct Circle {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double radius = 0;

    [[nodiscard]] bool holds(const Eigen::Vector2d& p) const {
        return (p - centre).norm() <= radius * (1 + kInside);
    }
};

Circle around(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return {(a + b) / 2, (a - b).norm() / 2};
}

Circle around(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    const Eigen::Vector2d u = b - a;
    const Eigen::Vector2d v = c - a;
    const double twice = 2 * (u.x() * v.y() - u.y() * v.x());
    if (std::abs(twice) < kFlatTriangle * u.squaredNorm()) {
        const Circle ab = around(a, b);
        const Circle ac = around(a, c);
        const Circle bc = around(b, c);
        return std::max({ab, ac, bc},
                        [](const Circle& x, const Circle& y) { return x.radius < y.radius; });
    }
    const Eigen::Vector2d to(v.y() * u.squaredNorm() - u.y() * v.squaredNorm(),
                             u.x() * v.squaredNorm() - v.x() * u.squaredNorm());
    return {a + to / twice, (to / twice).norm()};
}

using Points = std::vector<Eigen::Vector2d>;

/// Smallest circle around the corners before `on` that passes through `last` and `on`.
Circle through_two(const Points& hull, std::size_t last, std::size_t on) {
    Circle circle = around(hull[last], hull[on]);
    for (std::size_t k = 0; k < on; ++k) {
        if (!circle.holds(hull[k])) {
            circle = around(hull[last], hull[on], hull[k]);
        }
    }
    return circle;
}

/// Smallest circle around the corners before `last` that passes through `last`.
Circle through_one(const Points& hull, std::size_t last) {
    Circle circle{hull[last], 0};
    for (std::size_t j = 0; j < last; ++j) {
        if (!circle.holds(hull[j])) {
            circle = through_two(hull, last, j);
        }
    }
    return circle;
}

/// Smallest circle around the corners of a convex hull, point by point.
Circle smallest_circle(const Points& hull) {
    Circle circle;
    if (hull.empty()) {
        return circle;
    }
    circle.centre = hull[0];
    for (std::size_t i = 1; i < hull.size(); ++i) {
        if (!circle.holds(hull[i])) {
            circle = through_one(hull, i);
        }
    }
    return circle;
}

}  // namespace

Eigen::Vector3d up_at_zero(const Eigen::Vector3d& axis) {
    const Eigen::Vector3d wanted =
        std::abs(axis.z()) > kUpright ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
    return (wanted - wanted.dot(axis) * axis).normalized();
}

Cylinder smallest_cylinder(const decomp::mesh::TriMesh& mesh, const Eigen::Vector3d& axis) {
    const Eigen::Vector3d up = up_at_zero(axis);
    const Eigen::Vector3d side = up.cross(axis);
    std::vector<Eigen::Vector2d> shadow;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    std::vector<char> used(mesh.points.size(), 0);
    for (const auto& t : mesh.triangles) {
        used[t[0]] = used[t[1]] = used[t[2]] = 1;
    }
    shadow.reserve(mesh.points.size());
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        if (used[v] != 0) {
            const Eigen::Vector3d& p = mesh.points[v];
            shadow.emplace_back(p.dot(side), p.dot(up));
            low = std::min(low, p.dot(axis));
            high = std::max(high, p.dot(axis));
        }
    }
    const Circle circle = smallest_circle(orient::convex_hull(shadow));
    Cylinder out;
    out.axis = axis;
    if (!shadow.empty()) {
        out.low = circle.centre.x() * side + circle.centre.y() * up + low * axis;
        out.radius_mm = circle.radius;
        out.length_mm = high - low;
    }
    return out;
}

decomp::Pose<decomp::SetupFrame, decomp::ModelFrame> setup_from_model(const Cylinder& cylinder) {
    const Eigen::Vector3d up = up_at_zero(cylinder.axis);
    Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
    map.linear().row(0) = cylinder.axis;
    map.linear().row(1) = up.cross(cylinder.axis);
    map.linear().row(2) = up;
    map.translation() = -(map.linear() * cylinder.low);
    return decomp::Pose<decomp::SetupFrame, decomp::ModelFrame>(map);
}

Eigen::Vector3d tool_direction(double a_radians, int a_sign) {
    const double turn = a_sign * a_radians;
    return {0, -std::sin(turn), std::cos(turn)};
}

std::vector<Eigen::Vector3d> tool_directions(const Eigen::Vector3d& axis, int count, int a_sign) {
    const Eigen::Vector3d up = up_at_zero(axis);
    const Eigen::Vector3d side = up.cross(axis);
    std::vector<Eigen::Vector3d> out;
    for (int j = 0; j < count; ++j) {
        const Eigen::Vector3d d = tool_direction(2 * std::numbers::pi * j / count, a_sign);
        out.emplace_back(d.y() * side + d.z() * up);
    }
    return out;
}

double a_degrees(int position, int count) { return 360.0 * position / count; }

}  // namespace cam::check
