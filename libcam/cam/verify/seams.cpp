// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/seams.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace cam::verify {
namespace {

constexpr double kJoinMm = 0.003;  ///< printed coordinates of one point
constexpr double kReachMm = 0.45;  ///< of a wall's centre from the face that it makes
constexpr double kShortestMm = 2;  ///< loops that touch a face by less do not count

double distance_to(const Eigen::Vector2d& p, const std::vector<Section>& faces) {
    double least = 1e9;
    for (const Section& section : faces) {
        for (const auto& [x0, y0, x1, y1] : section.edges) {
            const Eigen::Vector2d a(x0, y0);
            const Eigen::Vector2d along = Eigen::Vector2d(x1, y1) - a;
            const double length2 = along.squaredNorm();
            const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
            least = std::min(least, (p - a - t * along).norm());
        }
    }
    return least;
}

}  // namespace

SeamCount count_seams(const std::vector<Bead>& beads, const Levels& levels, const Level& level,
                      const std::vector<Section>& mating) {
    SeamCount out;
    const bool any = std::any_of(mating.begin(), mating.end(),
                                 [](const Section& s) { return !s.edges.empty(); });
    const auto at = [&](std::uint32_t k) -> const Bead& { return beads[levels.order[k]]; };
    std::uint32_t k = level.first;
    while (k < level.last) {
        const std::uint32_t first = k;
        const auto follows = [&](std::uint32_t i) {
            return std::hypot(at(i).x0 - at(i - 1).x1, at(i).y0 - at(i - 1).y1) <= kJoinMm;
        };
        ++k;
        while (k < level.last && at(k).outer_wall == at(first).outer_wall && follows(k)) {
            ++k;
        }
        const Bead& begin = at(first);
        const Bead& end = at(k - 1);
        const bool closed =
            k - first > 2 && std::hypot(end.x1 - begin.x0, end.y1 - begin.y0) <= kJoinMm;
        if (!begin.outer_wall || !closed) {
            continue;
        }
        ++out.loops;
        if (!any) {
            continue;
        }
        double along = 0;
        for (std::uint32_t i = first; i < k; ++i) {
            const Eigen::Vector2d a(at(i).x0, at(i).y0);
            const Eigen::Vector2d b(at(i).x1, at(i).y1);
            const double length = (b - a).norm();
            const int samples = 1 + static_cast<int>(length);
            for (int s = 0; s < samples; ++s) {
                const Eigen::Vector2d p = a + (s + 0.5) / samples * (b - a);
                along += distance_to(p, mating) <= kReachMm ? length / samples : 0;
            }
        }
        if (along >= kShortestMm) {
            ++out.touching;
            out.on_face += distance_to({begin.x0, begin.y0}, mating) <= kReachMm ? 1 : 0;
        }
    }
    return out;
}

}  // namespace cam::verify
