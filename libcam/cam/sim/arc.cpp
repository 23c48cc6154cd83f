// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/arc.h"

#include <algorithm>
#include <cmath>

namespace cam::sim {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kWholeTurnBelow = 5e-7;  ///< rad, as Grbl's ARC_ANGULAR_TRAVEL_EPSILON
constexpr double kLeastToleranceMm = 1e-4;
constexpr double kMostChords = 100000;

}  // namespace

std::vector<Point> arc_points(const Arc& arc, double tolerance_mm) {
    const double begin_u = arc.from[arc.u] - arc.centre_u;
    const double begin_v = arc.from[arc.v] - arc.centre_v;
    const double end_u = arc.to[arc.u] - arc.centre_u;
    const double end_v = arc.to[arc.v] - arc.centre_v;
    const double radius = std::hypot(begin_u, begin_v);
    double sweep = std::atan2(begin_u * end_v - begin_v * end_u, begin_u * end_u + begin_v * end_v);
    if (arc.clockwise && sweep >= -kWholeTurnBelow) {
        sweep -= 2 * kPi;
    } else if (!arc.clockwise && sweep <= kWholeTurnBelow) {
        sweep += 2 * kPi;
    }
    const double sagitta = std::clamp(tolerance_mm, kLeastToleranceMm, radius > 0 ? radius : 1.0);
    const double chords = std::clamp(
        std::floor(std::abs(0.5 * sweep * radius) / std::sqrt(sagitta * (2 * radius - sagitta))),
        1.0, kMostChords);
    std::vector<Point> points;
    for (double i = 1; i < chords; ++i) {
        const double angle = sweep * i / chords;
        Point point{};
        for (std::size_t axis = 0; axis < kAxes; ++axis) {
            point[axis] = arc.from[axis] + (arc.to[axis] - arc.from[axis]) * i / chords;
        }
        point[arc.u] = arc.centre_u + begin_u * std::cos(angle) - begin_v * std::sin(angle);
        point[arc.v] = arc.centre_v + begin_u * std::sin(angle) + begin_v * std::cos(angle);
        points.push_back(point);
    }
    points.push_back(arc.to);
    return points;
}

bool centre_of(Arc& arc, double radius_mm) {
    const double du = arc.to[arc.u] - arc.from[arc.u];
    const double dv = arc.to[arc.v] - arc.from[arc.v];
    const double chord = std::hypot(du, dv);
    const double square = radius_mm * radius_mm - chord * chord / 4;
    if (chord == 0 || square < -0.01) {
        return false;
    }
    // The centre lies to the left of the chord for the shorter way round against the clock.
    const double height = std::sqrt(std::max(square, 0.0)) / chord;
    const double side = (arc.clockwise ? -1 : 1) * (radius_mm < 0 ? -1 : 1) * height;
    arc.centre_u = arc.from[arc.u] + du / 2 - dv * side;
    arc.centre_v = arc.from[arc.v] + dv / 2 + du * side;
    return true;
}

}  // namespace cam::sim
