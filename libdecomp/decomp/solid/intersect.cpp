// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/intersect.h"

#include "decomp/solid/boundary.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace decomp::solid {

namespace {

constexpr double kParallel = 1e-6;  ///< sine of the angle between directions that count as one
constexpr double kSlender = 1e-3;   ///< a longer ellipse is taken for a mistake
constexpr double kShortestMm = 1e-6;
constexpr double kOnCurveMm = 2e-6;  ///< between an end of the path and the curve

std::optional<EllipseCurve> section_of(const CylinderSurface& cylinder, const PlaneSurface& plane) {
    const double along = plane.normal.dot(cylinder.axis);
    if (std::abs(along) < kSlender) {
        return std::nullopt;
    }
    EllipseCurve curve;
    curve.centre = cylinder.origin +
                   cylinder.axis * ((plane.offset_mm - plane.normal.dot(cylinder.origin)) / along);
    const Eigen::Vector3d minor = cylinder.axis.cross(plane.normal);
    if (minor.norm() < kParallel) {
        const Eigen::Vector3d u = reference_direction(cylinder.axis);
        curve.major = cylinder.radius_mm * u;
        curve.minor = cylinder.radius_mm * cylinder.axis.cross(u);
        return curve;
    }
    curve.minor = cylinder.radius_mm * minor.normalized();
    curve.major = (cylinder.radius_mm / std::abs(along)) * minor.normalized().cross(plane.normal);
    curve.circle = false;
    return curve;
}

std::optional<BoundedCurve> line_along(const std::vector<Eigen::Vector3d>& path) {
    const Eigen::Vector3d way = path.back() - path.front();
    const double length = way.norm();
    if (length < kShortestMm) {
        return std::nullopt;
    }
    return BoundedCurve{LineCurve{path.front(), way / length}, 0, length};
}

std::optional<BoundedCurve> arc_along(EllipseCurve curve, const std::vector<Eigen::Vector3d>& path,
                                      bool closed) {
    double turn = 0;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        turn += turn_between(parameter_of(curve, path[i]), parameter_of(curve, path[i + 1]));
    }
    if (turn < 0) {
        curve.minor = -curve.minor;
        turn = -turn;
    }
    constexpr double kRound = 2 * std::numbers::pi;
    if (closed) {
        if (std::abs(turn - kRound) > 0.1) {
            return std::nullopt;
        }
        return BoundedCurve{curve, 0, kRound};
    }
    const double t0 = parameter_of(curve, path.front());
    double t1 = parameter_of(curve, path.back());
    t1 += kRound * std::round((t0 + turn - t1) / kRound);
    if ((point_at(curve, t0) - path.front()).norm() > kOnCurveMm ||
        (point_at(curve, t1) - path.back()).norm() > kOnCurveMm || t1 - t0 > kRound + kParallel ||
        (t1 - t0) * curve.minor.norm() < kShortestMm) {
        return std::nullopt;
    }
    return BoundedCurve{curve, t0, t1};
}

/// Along the axis of a cylinder, where a plane or another cylinder touches or cuts it.
std::optional<BoundedCurve> generator_along(const Eigen::Vector3d& axis,
                                            const std::vector<Eigen::Vector3d>& path, bool closed) {
    auto line = closed ? std::nullopt : line_along(path);
    if (!line ||
        std::get<LineCurve>(line->curve).direction.cross(axis).norm() * line->t1 > kOnCurveMm) {
        return std::nullopt;
    }
    return line;
}

}  // namespace

std::optional<BoundedCurve> curve_along(const Surface& a, const Surface& b,
                                        const std::vector<Eigen::Vector3d>& path, bool closed) {
    const auto* plane_a = std::get_if<PlaneSurface>(&a);
    const auto* plane_b = std::get_if<PlaneSurface>(&b);
    if (plane_a != nullptr && plane_b != nullptr) {
        return closed ? std::nullopt : line_along(path);
    }
    const auto* cylinder_a = std::get_if<CylinderSurface>(&a);
    const auto* cylinder_b = std::get_if<CylinderSurface>(&b);
    if (cylinder_a != nullptr && cylinder_b != nullptr) {
        return cylinder_a->axis.cross(cylinder_b->axis).norm() < kParallel
                   ? generator_along(cylinder_a->axis, path, closed)
                   : std::nullopt;
    }
    const PlaneSurface* plane = plane_a != nullptr ? plane_a : plane_b;
    const CylinderSurface* cylinder = cylinder_a != nullptr ? cylinder_a : cylinder_b;
    if (plane == nullptr || cylinder == nullptr) {
        return std::nullopt;
    }
    if (std::abs(plane->normal.dot(cylinder->axis)) < kParallel) {
        return generator_along(cylinder->axis, path, closed);
    }
    const auto section = section_of(*cylinder, *plane);
    return section ? arc_along(*section, path, closed) : std::nullopt;
}

}  // namespace decomp::solid
