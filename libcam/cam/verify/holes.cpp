// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/holes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace cam::verify {
namespace {

constexpr double kSmallestMm = 1;
constexpr double kLargestMm = 30;
constexpr double kRoundness = 0.88;  ///< 4 pi area / perimeter^2; a hexagon has 0.91
constexpr double kWallMm = 0.3;      ///< of the first wall, surely covered beside the hole
constexpr double kOutlineMm = 0.05;

using Point = std::pair<double, double>;

/// Loops of a section: edges chained by their end points, which neighbours share bit for bit.
std::vector<std::vector<Point>> loops_of(const Section& section) {
    std::vector<std::size_t> order(section.edges.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    const auto start = [&](std::size_t i) {
        return Point(section.edges[i][0], section.edges[i][1]);
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(start(a), a) < std::pair(start(b), b);
    });
    std::vector<char> used(order.size(), 0);
    std::vector<std::vector<Point>> loops;
    for (std::size_t first = 0; first < order.size(); ++first) {
        std::vector<Point> loop;
        std::size_t edge = first;
        while (used[edge] == 0) {
            used[edge] = 1;
            loop.push_back(start(edge));
            const Point end(section.edges[edge][2], section.edges[edge][3]);
            auto next =
                std::lower_bound(order.begin(), order.end(), end,
                                 [&](std::size_t i, const Point& p) { return start(i) < p; });
            while (next != order.end() && start(*next) == end && used[*next] != 0) {
                ++next;
            }
            if (next == order.end() || start(*next) != end) {
                break;
            }
            edge = *next;
        }
        if (loop.size() > 2) {
            loops.push_back(std::move(loop));
        }
    }
    return loops;
}

}  // namespace

std::vector<RoundHole> round_holes(const Section& section) {
    std::vector<RoundHole> out;
    for (const auto& loop : loops_of(section)) {
        double area = 0;
        double around = 0;
        Eigen::Vector2d moment = Eigen::Vector2d::Zero();
        const Eigen::Vector2d base(loop.front().first, loop.front().second);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Point& p = loop[i];
            const Point& q = loop[(i + 1) % loop.size()];
            const Eigen::Vector2d a = Eigen::Vector2d(p.first, p.second) - base;
            const Eigen::Vector2d b = Eigen::Vector2d(q.first, q.second) - base;
            const double twice = a.x() * b.y() - a.y() * b.x();
            area += twice / 2;
            moment += twice / 6 * (a + b);
            around += (b - a).norm();
        }
        const double room = -area;  // holes run clockwise
        if (room <= 0 || 4 * std::numbers::pi * room < kRoundness * around * around) {
            continue;
        }
        RoundHole hole;
        hole.diameter_mm = std::sqrt(4 * room / std::numbers::pi);
        hole.centre = base + moment / area;
        for (const Point& p : loop) {
            hole.reach_mm =
                std::max(hole.reach_mm, (Eigen::Vector2d(p.first, p.second) - hole.centre).norm());
        }
        if (hole.diameter_mm >= kSmallestMm && hole.diameter_mm <= kLargestMm) {
            out.push_back(hole);
        }
    }
    return out;
}

double free_diameter_mm(const RoundHole& hole, const Bitmap& inside, const Bitmap& beads,
                        double pixel_mm) {
    const double reach = hole.reach_mm + kWallMm;
    const auto pixel = [&](double at) { return static_cast<int>(std::floor(at / pixel_mm)); };
    std::size_t free = 0;
    for (int j = pixel(hole.centre.y() - reach); j <= pixel(hole.centre.y() + reach); ++j) {
        for (int i = pixel(hole.centre.x() - reach); i <= pixel(hole.centre.x() + reach); ++i) {
            const Eigen::Vector2d at((i + 0.5) * pixel_mm, (j + 0.5) * pixel_mm);
            const double from_centre = (at - hole.centre).norm();
            // Beyond the hole only what belongs to its wall says something.
            const bool asked = from_centre <= hole.reach_mm + kOutlineMm ||
                               (from_centre <= reach && inside.get(i, j));
            free += asked && !beads.get(i, j) ? 1 : 0;
        }
    }
    const double area = static_cast<double>(free) * pixel_mm * pixel_mm;
    return std::sqrt(4 * area / std::numbers::pi);
}

}  // namespace cam::verify
