// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/solid.h"

#include <Eigen/Geometry>

#include <cmath>

namespace decomp::solid {

namespace {

void move(Surface& surface, const Eigen::Isometry3d& motion) {
    if (auto* plane = std::get_if<PlaneSurface>(&surface)) {
        const Eigen::Vector3d on_it = motion * (plane->normal * plane->offset_mm);
        plane->normal = motion.linear() * plane->normal;
        plane->offset_mm = plane->normal.dot(on_it);
    } else if (auto* cylinder = std::get_if<CylinderSurface>(&surface)) {
        cylinder->origin = motion * cylinder->origin;
        cylinder->axis = motion.linear() * cylinder->axis;
    } else if (auto* cone = std::get_if<ConeSurface>(&surface)) {
        cone->apex = motion * cone->apex;
        cone->axis = motion.linear() * cone->axis;
    } else {
        auto& torus = std::get<TorusSurface>(surface);
        torus.centre = motion * torus.centre;
        torus.axis = motion.linear() * torus.axis;
    }
}

void move(Curve& curve, const Eigen::Isometry3d& motion) {
    if (auto* line = std::get_if<LineCurve>(&curve)) {
        line->origin = motion * line->origin;
        line->direction = motion.linear() * line->direction;
    } else {
        auto& ellipse = std::get<EllipseCurve>(curve);
        ellipse.centre = motion * ellipse.centre;
        ellipse.major = motion.linear() * ellipse.major;
        ellipse.minor = motion.linear() * ellipse.minor;
    }
}

}  // namespace

Solid moved(Solid solid, const Eigen::Isometry3d& motion) {
    for (Eigen::Vector3d& p : solid.vertices) {
        p = motion * p;
    }
    for (Edge& edge : solid.edges) {
        move(edge.curve, motion);
    }
    for (Face& face : solid.faces) {
        move(face.surface, motion);
    }
    return solid;
}

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

/// To p from the nearest point of the circle in the middle of the tube.
Eigen::Vector3d from_tube(const TorusSurface& torus, const Eigen::Vector3d& p) {
    const Eigen::Vector3d d = p - torus.centre;
    return d - torus.major_mm * across(d, torus.axis).normalized();
}

}  // namespace

double distance_mm(const Surface& surface, const Eigen::Vector3d& p) {
    if (const auto* plane = std::get_if<PlaneSurface>(&surface)) {
        return plane->normal.dot(p) - plane->offset_mm;
    }
    if (const auto* cylinder = std::get_if<CylinderSurface>(&surface)) {
        return across(p - cylinder->origin, cylinder->axis).norm() - cylinder->radius_mm;
    }
    if (const auto* torus = std::get_if<TorusSurface>(&surface)) {
        return from_tube(*torus, p).norm() - torus->minor_mm;
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
    if (const auto* torus = std::get_if<TorusSurface>(&surface)) {
        return from_tube(*torus, p).normalized();
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
