// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/bridge.h"

#include "cam/fdm/infill.h"
#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace cam::fdm {

namespace {

using polygon::Paths;

constexpr int kDirections = 36;         // 5 degrees apart
constexpr double kReachMm = 0.5;        // how far beyond a line's end its rest may begin
constexpr double kRestWidthMm = 1.2;    // how far a bridge goes on over its rests
constexpr double kMostUnrested = 0.05;  // of a patch's area, for a bridge that carries itself
constexpr double kLeastAreaMm2 = 0.5;   // smaller patches are carried by their neighbours

/// How bad a direction is: length of lines without a rest at both ends, then the longest span; mm,
/// on a grid of 0.01 mm such that rounding does not choose.
std::pair<long, long> cost(const Paths& patch, const Paths& below, decomp::Angle direction) {
    const polygon::Box box = polygon::bounds(patch);
    const double extent = polygon::to_mm(std::max(box.max.x - box.min.x, box.max.y - box.min.y));
    const double spacing = std::clamp(extent / 24, 0.2, 2.0);
    double unrested = 0;
    double longest = 0;
    for (const Line& line : fill_with_lines(patch, {spacing, direction, -1})) {
        const Eigen::Vector2d along = line.back() - line.front();
        const double length = along.norm();
        if (length <= 0) {
            continue;
        }
        const Eigen::Vector2d step = along * (kReachMm / length);
        const bool rests = polygon::contains(below, polygon::from_mm(line.front() - step)) &&
                           polygon::contains(below, polygon::from_mm(line.back() + step));
        if (rests) {
            longest = std::max(longest, length);
        } else {
            unrested += length * spacing;
        }
    }
    return {std::lround(unrested * 100), std::lround(longest * 100)};
}

}  // namespace

std::vector<BridgeArea> find_bridges(const Paths& inside, const Paths& below, double spacing_mm) {
    std::vector<BridgeArea> out;
    const Paths air = polygon::opened(polygon::subtract(inside, below), spacing_mm / 2);
    for (const polygon::Island& island : polygon::islands(air)) {
        const Paths patch = island.loops();
        if (polygon::area_mm2(patch) < kLeastAreaMm2) {
            continue;
        }
        int best = 0;
        std::pair<long, long> least;
        for (int i = 0; i < kDirections; ++i) {
            const auto now = cost(patch, below, decomp::Angle::degrees(180.0 * i / kDirections));
            if (i == 0 || now < least) {
                least = now;
                best = i;
            }
        }
        BridgeArea& bridge = out.emplace_back();
        bridge.area = polygon::intersect(polygon::offset(patch, kRestWidthMm), inside);
        bridge.direction = decomp::Angle::degrees(180.0 * best / kDirections);
        bridge.air = patch;
        bridge.span_mm = static_cast<double>(least.second) / 100;
        bridge.rests =
            static_cast<double>(least.first) / 100 < kMostUnrested * polygon::area_mm2(patch);
    }
    return out;
}

}  // namespace cam::fdm
