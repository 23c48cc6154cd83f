// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/intersect.h"

#include "decomp/solid/boundary.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace decomp::solid {

namespace {

constexpr double kParallel = 1e-6;  ///< sine of the angle between directions that count as one
constexpr double kSlender = 1e-3;   ///< a longer ellipse is taken for a mistake
constexpr double kShortestMm = 1e-6;
constexpr double kTouchingMm = 1e-5;  ///< a torus so near to a surface touches it
constexpr double kOnCurveMm = 1e-5;   ///< between the curve and its ends or surfaces
constexpr double kSlideMm = 2e-4;     ///< of a line along a surface that touches; it stays on it
constexpr double kCoaxial = 1e-4;     ///< between axes that may be one; the curve decides

EllipseCurve circle_about(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                          double radius_mm) {
    const Eigen::Vector3d u = reference_direction(axis);
    return {centre, radius_mm * u, radius_mm * axis.cross(u), true};
}

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
        return circle_about(curve.centre, cylinder.axis, cylinder.radius_mm);
    }
    curve.minor = cylinder.radius_mm * minor.normalized();
    curve.major = (cylinder.radius_mm / std::abs(along)) * minor.normalized().cross(plane.normal);
    curve.circle = false;
    return curve;
}

std::optional<EllipseCurve> section_of(const ConeSurface& cone, const PlaneSurface& plane) {
    const double along = plane.normal.dot(cone.axis);
    const double slope = std::tan(cone.half_angle);
    const double ahead = plane.offset_mm - plane.normal.dot(cone.apex);
    const Eigen::Vector3d inclined = plane.normal - along * cone.axis;
    if (inclined.norm() < kParallel) {
        const double height = ahead / along;
        return height > 0 ? std::optional(circle_about(cone.apex + height * cone.axis, cone.axis,
                                                       height * slope))
                          : std::nullopt;
    }
    // The plane meets the two straight lines of the cone that lie in its direction of descent.
    const Eigen::Vector3d down = inclined.normalized();
    const double low = ahead / (along + inclined.norm() * slope);
    const double high = ahead / (along - inclined.norm() * slope);
    if (!(low > 0) || !(high > 0) || high * kSlender > low || low * kSlender > high) {
        return std::nullopt;  // a parabola or hyperbola
    }
    const Eigen::Vector3d from = low * (cone.axis + slope * down);
    const Eigen::Vector3d to = high * (cone.axis - slope * down);
    const Eigen::Vector3d middle = (from + to) / 2;
    const double width_mm =
        std::sqrt(std::pow(cone.axis.dot(middle) * slope, 2) - std::pow(down.dot(middle), 2));
    return EllipseCurve{cone.apex + middle, (from - to) / 2, width_mm * cone.axis.cross(down),
                        false};
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
        std::get<LineCurve>(line->curve).direction.cross(axis).norm() * line->t1 > kSlideMm) {
        return std::nullopt;
    }
    return line;
}

/// Along a straight line of a cone.
std::optional<BoundedCurve> generator_along(const ConeSurface& cone,
                                            const std::vector<Eigen::Vector3d>& path, bool closed) {
    auto line = closed ? std::nullopt : line_along(path);
    if (!line || std::get<LineCurve>(line->curve).direction.cross(cone.apex - path.front()).norm() >
                     kOnCurveMm) {
        return std::nullopt;
    }
    return line;
}

std::optional<BoundedCurve> plane_curve(const PlaneSurface& plane, const CylinderSurface& cylinder,
                                        const std::vector<Eigen::Vector3d>& path, bool closed) {
    if (std::abs(plane.normal.dot(cylinder.axis)) < kParallel) {
        return generator_along(cylinder.axis, path, closed);
    }
    const auto section = section_of(cylinder, plane);
    return section ? arc_along(*section, path, closed) : std::nullopt;
}

std::optional<BoundedCurve> plane_curve(const PlaneSurface& plane, const ConeSurface& cone,
                                        const std::vector<Eigen::Vector3d>& path, bool closed) {
    if (std::abs(distance_mm(plane, cone.apex)) < kOnCurveMm) {
        return generator_along(cone, path, closed);
    }
    const auto section = section_of(cone, plane);
    return section ? arc_along(*section, path, closed) : std::nullopt;
}

/// A surface of revolution in a half plane through its axis, by radius and height over `origin`: a
/// straight line, or a circle.
struct Profile {
    Eigen::Vector3d origin;
    Eigen::Vector3d axis;
    Eigen::Vector2d on_it;      ///< a point of the line, the circle's centre
    Eigen::Vector2d direction;  ///< of the line; unit
    double radius_mm = 0;       ///< of the circle; 0: a line
};

Profile profile_of(const Surface& surface) {
    if (const auto* cylinder = std::get_if<CylinderSurface>(&surface)) {
        return {cylinder->origin, cylinder->axis, {cylinder->radius_mm, 0}, {0, 1}};
    }
    if (const auto* torus = std::get_if<TorusSurface>(&surface)) {
        return {torus->centre, torus->axis, {torus->major_mm, 0}, {0, 0}, torus->minor_mm};
    }
    const auto& cone = std::get<ConeSurface>(surface);
    return {cone.apex, cone.axis, {0, 0}, {std::sin(cone.half_angle), std::cos(cone.half_angle)}};
}

/// The same over another origin and axis; nothing where the axes are not one.
std::optional<Profile> about(Profile profile, const Profile& other) {
    const Eigen::Vector3d apart = profile.origin - other.origin;
    if (profile.axis.cross(other.axis).norm() > kCoaxial ||
        apart.cross(other.axis).norm() > kCoaxial) {
        return std::nullopt;
    }
    const double sense = profile.axis.dot(other.axis) < 0 ? -1 : 1;
    profile.on_it.y() = sense * profile.on_it.y() + other.axis.dot(apart);
    profile.direction.y() *= sense;
    profile.origin = other.origin;
    profile.axis = other.axis;
    return profile;
}

/// Where a profile crosses or touches a line, nearest to a point.
std::optional<Eigen::Vector2d> crossing(const Profile& profile, const Eigen::Vector2d& on_line,
                                        const Eigen::Vector2d& direction,
                                        const Eigen::Vector2d& near) {
    const Eigen::Vector2d apart = profile.on_it - on_line;
    if (profile.radius_mm == 0) {
        Eigen::Matrix2d both;
        both << direction, -profile.direction;
        return std::abs(both.determinant()) < kParallel
                   ? std::nullopt
                   : std::optional(
                         Eigen::Vector2d(on_line + direction * (both.inverse() * apart).x()));
    }
    const Eigen::Vector2d foot = on_line + direction * direction.dot(apart);
    const double off = (foot - profile.on_it).norm();
    if (std::abs(off - profile.radius_mm) <= kTouchingMm) {
        return foot;
    }
    if (off > profile.radius_mm) {
        return std::nullopt;
    }
    const Eigen::Vector2d half =
        direction * std::sqrt(profile.radius_mm * profile.radius_mm - off * off);
    return (foot + half - near).norm() < (foot - half - near).norm() ? Eigen::Vector2d(foot + half)
                                                                     : Eigen::Vector2d(foot - half);
}

/// In the half plane of a profile.
Eigen::Vector2d seen(const Profile& profile, const Eigen::Vector3d& p) {
    const Eigen::Vector3d d = p - profile.origin;
    const double height = profile.axis.dot(d);
    return {(d - height * profile.axis).norm(), height};
}

std::optional<BoundedCurve> circle_along(const Profile& profile,
                                         const std::optional<Eigen::Vector2d>& at,
                                         const std::vector<Eigen::Vector3d>& path, bool closed) {
    if (!at || at->x() < kShortestMm) {
        return std::nullopt;
    }
    return arc_along(circle_about(profile.origin + at->y() * profile.axis, profile.axis, at->x()),
                     path, closed);
}

/// The section of the tube in a plane through the axis, on the side of the path.
std::optional<BoundedCurve> meridian_along(const TorusSurface& torus, const Eigen::Vector3d& normal,
                                           const std::vector<Eigen::Vector3d>& path, bool closed) {
    Eigen::Vector3d out = normal.cross(torus.axis).normalized();
    out = out.dot(path.front() - torus.centre) < 0 ? Eigen::Vector3d(-out) : out;
    return arc_along({torus.centre + torus.major_mm * out, torus.minor_mm * out,
                      torus.minor_mm * torus.axis, true},
                     path, closed);
}

std::optional<BoundedCurve> plane_curve(const PlaneSurface& plane, const TorusSurface& torus,
                                        const std::vector<Eigen::Vector3d>& path, bool closed) {
    const double along = plane.normal.dot(torus.axis);
    if (std::abs(along) < kParallel) {
        return std::abs(distance_mm(plane, torus.centre)) < kOnCurveMm
                   ? meridian_along(torus, plane.normal, path, closed)
                   : std::nullopt;
    }
    if (plane.normal.cross(torus.axis).norm() > kParallel) {
        return std::nullopt;
    }
    const Profile profile = profile_of(torus);
    const Eigen::Vector2d level(0, (plane.offset_mm - plane.normal.dot(torus.centre)) / along);
    return circle_along(profile, crossing(profile, level, {1, 0}, seen(profile, path.front())),
                        path, closed);
}

std::optional<BoundedCurve> round_curve(const Surface& a, const Surface& b,
                                        const std::vector<Eigen::Vector3d>& path, bool closed) {
    const auto* cylinder_a = std::get_if<CylinderSurface>(&a);
    const auto* cylinder_b = std::get_if<CylinderSurface>(&b);
    if (cylinder_a != nullptr && cylinder_b != nullptr) {
        return cylinder_a->axis.cross(cylinder_b->axis).norm() < kParallel
                   ? generator_along(cylinder_a->axis, path, closed)
                   : std::nullopt;
    }
    const auto* torus = std::get_if<TorusSurface>(&a);
    const Surface& other = torus != nullptr ? b : a;
    torus = torus != nullptr ? torus : std::get_if<TorusSurface>(&b);
    const auto* cylinder = std::get_if<CylinderSurface>(&other);
    if (torus != nullptr && cylinder != nullptr &&
        std::abs(torus->axis.dot(cylinder->axis)) < kParallel) {
        return meridian_along(*torus, cylinder->axis, path, closed);  // a fillet that runs on
    }
    const bool swapped = std::holds_alternative<TorusSurface>(b);
    const Profile profile = profile_of(swapped ? b : a);
    const auto line = about(profile_of(swapped ? a : b), profile);
    return line && line->radius_mm == 0
               ? circle_along(
                     profile,
                     crossing(profile, line->on_it, line->direction, seen(profile, path.front())),
                     path, closed)
               : std::nullopt;
}

std::optional<BoundedCurve> curve_between(const Surface& a, const Surface& b,
                                          const std::vector<Eigen::Vector3d>& path, bool closed) {
    const auto* plane = std::get_if<PlaneSurface>(&a);
    const Surface& other = plane != nullptr ? b : a;
    plane = plane != nullptr ? plane : std::get_if<PlaneSurface>(&b);
    if (plane == nullptr) {
        return round_curve(a, b, path, closed);
    }
    if (const auto* cylinder = std::get_if<CylinderSurface>(&other)) {
        return plane_curve(*plane, *cylinder, path, closed);
    }
    if (const auto* cone = std::get_if<ConeSurface>(&other)) {
        return plane_curve(*plane, *cone, path, closed);
    }
    if (const auto* torus = std::get_if<TorusSurface>(&other)) {
        return plane_curve(*plane, *torus, path, closed);
    }
    return closed ? std::nullopt : line_along(path);
}

}  // namespace

std::optional<BoundedCurve> curve_along(const Surface& a, const Surface& b,
                                        const std::vector<Eigen::Vector3d>& path, bool closed) {
    auto found = curve_between(a, b, path, closed);
    // Planes of needles are no measure of a line between them.
    if (!found ||
        (std::holds_alternative<PlaneSurface>(a) && std::holds_alternative<PlaneSurface>(b))) {
        return found;
    }
    if (!closed) {
        found->off_mm = std::max((point_at(found->curve, found->t0) - path.front()).norm(),
                                 (point_at(found->curve, found->t1) - path.back()).norm());
    }
    constexpr int kPieces = 8;
    for (int i = 0; i <= kPieces; ++i) {
        const Eigen::Vector3d p =
            point_at(found->curve, found->t0 + (found->t1 - found->t0) * i / kPieces);
        for (const Surface* surface : {&a, &b}) {
            found->off_mm = std::max(found->off_mm, std::abs(distance_mm(*surface, p)));
        }
    }
    return found->off_mm <= kOnCurveMm ? found : std::nullopt;
}

}  // namespace decomp::solid
