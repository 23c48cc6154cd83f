// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/solid.h"

#include <Eigen/Geometry>

#include <cmath>

namespace decomp::solid {

Eigen::Vector3d point_at(const Curve& curve, double t) {
    if (const auto* line = std::get_if<LineCurve>(&curve)) {
        return line->origin + t * line->direction;
    }
    const auto& ellipse = std::get<EllipseCurve>(curve);
    return ellipse.centre + std::cos(t) * ellipse.major + std::sin(t) * ellipse.minor;
}

double parameter_of(const Curve& curve, const Eigen::Vector3d& p) {
    if (const auto* line = std::get_if<LineCurve>(&curve)) {
        return line->direction.dot(p - line->origin);
    }
    const auto& ellipse = std::get<EllipseCurve>(curve);
    const Eigen::Vector3d d = p - ellipse.centre;
    return std::atan2(d.dot(ellipse.minor) / ellipse.minor.squaredNorm(),
                      d.dot(ellipse.major) / ellipse.major.squaredNorm());
}

namespace {

Eigen::Vector3d across(const Eigen::Vector3d& d, const Eigen::Vector3d& axis) {
    return d - axis * axis.dot(d);
}

}  // namespace

double distance_mm(const Surface& surface, const Eigen::Vector3d& p) {
    if (const auto* plane = std::get_if<PlaneSurface>(&surface)) {
        return plane->normal.dot(p) - plane->offset_mm;
    }
    if (const auto* cylinder = std::get_if<CylinderSurface>(&surface)) {
        return across(p - cylinder->origin, cylinder->axis).norm() - cylinder->radius_mm;
    }
    const auto& cone = std::get<ConeSurface>(surface);
    const Eigen::Vector3d d = p - cone.apex;
    return across(d, cone.axis).norm() * std::cos(cone.half_angle) -
           cone.axis.dot(d) * std::sin(cone.half_angle);
}

Eigen::Vector3d normal_at(const Surface& surface, const Eigen::Vector3d& p) {
    if (const auto* plane = std::get_if<PlaneSurface>(&surface)) {
        return plane->normal;
    }
    if (const auto* cylinder = std::get_if<CylinderSurface>(&surface)) {
        return across(p - cylinder->origin, cylinder->axis).normalized();
    }
    const auto& cone = std::get<ConeSurface>(surface);
    return across(p - cone.apex, cone.axis).normalized() * std::cos(cone.half_angle) -
           cone.axis * std::sin(cone.half_angle);
}

Eigen::Vector3d reference_direction(const Eigen::Vector3d& axis) {
    Eigen::Index least = 0;
    axis.cwiseAbs().minCoeff(&least);
    return across(Eigen::Vector3d::Unit(least), axis).normalized();
}

}  // namespace decomp::solid
