// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/tool/tool.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

/// The drop of a tool by plain search: no closed form, no grid, no edges. Shares nothing with
/// cam/cutter but the profile z(r) of cam/tool.
namespace tests {

/// Largest value of a concave function on [low, high], by golden section.
template <class Function>
double highest_of(double low, double high, const Function& value) {
    constexpr double kGolden = 0.6180339887498949;
    double a = high - kGolden * (high - low);
    double b = low + kGolden * (high - low);
    double at_a = value(a);
    double at_b = value(b);
    double best = std::max({at_a, at_b, value(low), value(high)});
    for (int step = 0; step < 56; ++step) {
        if (at_a > at_b) {
            high = std::exchange(b, a);
            at_b = at_a;
            a = high - kGolden * (high - low);
            at_a = value(a);
        } else {
            low = std::exchange(a, b);
            at_a = at_b;
            b = low + kGolden * (high - low);
            at_b = value(b);
        }
        best = std::max({best, at_a, at_b});
    }
    return best;
}

/// The profile, continued so steeply beyond the radius that nothing there counts.
inline double steep_profile(const cam::tool::Tool& tool, double r) {
    const double radius = tool.radius_mm();
    return *cam::tool::cutter_height_mm(tool, std::min(r, radius)) +
           2e4 * std::max(0.0, r - radius);
}

/// The tip's height if there were only this triangle.
inline double slow_drop_on(const std::array<Eigen::Vector3d, 3>& triangle,
                           const cam::tool::Tool& tool, const Eigen::Vector2d& at) {
    std::array<Eigen::Vector3d, 3> p = triangle;
    std::sort(p.begin(), p.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
    const auto on = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double y) {
        return b.y() > a.y() ? Eigen::Vector3d(a + (b - a) * ((y - a.y()) / (b.y() - a.y()))) : a;
    };
    return highest_of(p[0].y(), p[2].y(), [&](double y) {
        const Eigen::Vector3d left = on(p[0], p[2], y);
        const Eigen::Vector3d right = y < p[1].y() ? on(p[0], p[1], y) : on(p[1], p[2], y);
        return highest_of(0, 1, [&](double share) {
            const Eigen::Vector3d s = left + share * (right - left);
            return s.z() - steep_profile(tool, (s.head<2>() - at).norm());
        });
    });
}

/// Over all triangles, or the floor. Triangles that cannot be the highest are passed over.
inline double slow_drop(const decomp::mesh::TriMesh& mesh, const cam::tool::Tool& tool,
                        const Eigen::Vector2d& at, double floor) {
    std::vector<std::pair<double, std::array<Eigen::Vector3d, 3>>> bounds;
    for (const auto& t : mesh.triangles) {
        const std::array<Eigen::Vector3d, 3> p{mesh.points[t[0]], mesh.points[t[1]],
                                               mesh.points[t[2]]};
        Eigen::AlignedBox2d box;
        double top = floor;
        for (const auto& corner : p) {
            box.extend(Eigen::Vector2d(corner.head<2>()));
            top = std::max(top, corner.z());
        }
        const double away = box.exteriorDistance(at);
        if (away <= tool.radius_mm()) {
            bounds.emplace_back(top - *cam::tool::cutter_height_mm(tool, away), p);
        }
    }
    std::sort(bounds.begin(), bounds.end(),
              [](const auto& a, const auto& b) { return a.first > b.first; });
    double tip = floor;
    for (const auto& [bound, triangle] : bounds) {
        if (bound <= tip) {
            break;
        }
        tip = std::max(tip, slow_drop_on(triangle, tool, at));
    }
    return tip;
}

}  // namespace tests
