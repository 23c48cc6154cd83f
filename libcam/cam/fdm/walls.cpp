// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/walls.h"

#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"

#include <cmath>
#include <utility>

namespace cam::fdm {

namespace {

using polygon::Paths;

/// Two sides of a wall may come as near to each other as this part of the spacing; nearer, one bead
/// takes both.
constexpr double kLeastPairFraction = 0.6;
constexpr double kOutputToleranceMm = 0.004;

double total_perimeter_mm(const Paths& region) {
    double sum = 0;
    for (const auto& loop : region) {
        sum += polygon::perimeter_mm(loop);
    }
    return sum;
}

/// Whether `inner` is `outer` shrunk by `distance` and nothing of it went lost: between parallel
/// outlines lies a trapezoid per edge.
bool is_plain_inset(const Paths& outer, const Paths& inner, double distance_mm) {
    constexpr double kLostMm2 = 0.01;
    const double band = distance_mm * (total_perimeter_mm(outer) + total_perimeter_mm(inner)) / 2;
    return outer.size() == inner.size() &&
           std::abs(polygon::area_mm2(outer) - polygon::area_mm2(inner) - band) < kLostMm2;
}

}  // namespace

Walls make_walls(const Paths& region, const BeadSize& bead, int count) {
    Walls out;
    const double spacing = bead.spacing_mm();
    const double margin = kLeastPairFraction / 2 * spacing;
    Paths previous = region;
    out.inside = region;
    for (int i = 0; i < count && !previous.empty(); ++i) {
        const double step = i == 0 ? bead.width_mm / 2 : spacing;
        Paths wall = polygon::offset(polygon::offset(previous, -(step + margin)), margin);
        if (!is_plain_inset(previous, wall, step)) {
            const Paths covered = polygon::offset(wall, i == 0 ? bead.width_mm / 2 : spacing / 2);
            const Paths left = polygon::subtract(out.inside, covered);
            Paths& uncovered = i == 0 ? out.thin : out.gaps;
            uncovered.insert(uncovered.end(), left.begin(), left.end());
        }
        out.inside = polygon::offset(wall, -spacing / 2);
        previous = wall;
        if (!wall.empty()) {
            out.loops.push_back(std::move(wall));
        }
    }
    return out;
}

std::vector<Line> closed_lines(const Paths& loops) {
    std::vector<Line> out;
    for (const auto& loop : polygon::simplified(loops, kOutputToleranceMm)) {
        Line& line = out.emplace_back();
        line.reserve(loop.size() + 1);
        for (const auto& p : loop) {
            line.push_back(polygon::to_mm(p));
        }
        line.push_back(line.front());
    }
    return out;
}

}  // namespace cam::fdm
