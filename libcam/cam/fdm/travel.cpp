// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/travel.h"

#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;

constexpr double kSurfaceWidths = 0.3;  // centres of outer walls lie at 0.5
constexpr double kBringInWidths = 1.5;  // ends of beads are at most that far from inner ways
constexpr double kToleranceMm = 0.02;   // of the outlines along which ways run
constexpr double kLongestDetour = 4;    // times the straight way …
constexpr double kFreeDetourMm = 20;    // … and this much
constexpr double kAtEnd = 1e-7;         // of a way: its own end on the boundary
constexpr double kStraightOnly = 1e-9;  // mm, no way at all

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double length_mm(const std::vector<Vector2d>& by, const Vector2d& from, const Vector2d& to) {
    double sum = 0;
    Vector2d at = from;
    for (const Vector2d& p : by) {
        sum += (p - at).norm();
        at = p;
    }
    return sum + (to - at).norm();
}

/// Loops grouped by island, and the island of each.
polygon::Paths by_island(const polygon::Paths& region, std::vector<std::size_t>& island_of_loop) {
    polygon::Paths out;
    const auto islands = polygon::islands(region);
    for (std::size_t i = 0; i < islands.size(); ++i) {
        for (auto& loop : islands[i].loops()) {
            out.push_back(loop);
            island_of_loop.push_back(i);
        }
    }
    return out;
}

}  // namespace

TravelMap::TravelMap(const polygon::Paths& slice, double width_mm, double walls_mm)
    : width_mm_(width_mm),
      surface_(polygon::offset(slice, -kSurfaceWidths * width_mm)),
      inner_(by_island(polygon::simplified(polygon::offset(slice, -walls_mm), kToleranceMm),
                       island_of_loop_)) {}

/// The point itself inside the inner region, else the nearest of its boundary; false when that is
/// far.
bool TravelMap::brought_in(const Vector2d& p, Node& node) const {
    node.at_mm = p;
    node.on_boundary = false;
    if (inner_.contains(p)) {
        return true;
    }
    const auto nearest = inner_.nearest(p, kBringInWidths * width_mm_);
    if (!nearest || surface_.crosses(p, nearest->at_mm)) {
        return false;
    }
    node = {nearest->at_mm, true, *nearest};
    return true;
}

/// Whether the way from a node on the boundary starts into the region, which lies on the left.
bool TravelMap::leads_in(const Node& node, const Vector2d& towards) const {
    if (!node.on_boundary) {
        return true;
    }
    const auto& loop = inner_.loops()[node.point.loop];
    const std::size_t n = loop.size();
    const std::size_t e = node.point.edge;
    const Vector2d way = towards - node.at_mm;
    const Vector2d along = loop[(e + 1) % n] - loop[e];
    const bool left = cross(along, way) > 0;
    if (node.point.on_edge > 0 && node.point.on_edge < 1) {
        return left;
    }
    // At a vertex: between the edge that comes in and the one that goes out.
    const Vector2d in = node.point.on_edge > 0 ? along : Vector2d(loop[e] - loop[(e + n - 1) % n]);
    const Vector2d out =
        node.point.on_edge > 0 ? Vector2d(loop[(e + 2) % n] - loop[(e + 1) % n]) : along;
    const bool left_in = cross(in, way) > 0;
    const bool left_out = cross(out, way) > 0;
    return cross(in, out) >= 0 ? left_in && left_out : left_in || left_out;
}

bool TravelMap::sees(const Node& a, const Node& b) const {
    if (!leads_in(a, b.at_mm) || !leads_in(b, a.at_mm)) {
        return false;
    }
    const auto met = inner_.meetings(a.at_mm, b.at_mm);
    return std::all_of(met.begin(), met.end(),
                       [](const Meeting& m) { return m.along < kAtEnd || m.along > 1 - kAtEnd; });
}

/// The boundary between two points of one loop, by the shorter side.
void TravelMap::follow(const BoundaryPoint& from, const BoundaryPoint& to,
                       std::vector<Node>& way) const {
    const auto& loop = inner_.loops()[from.loop];
    const std::size_t n = loop.size();
    const auto vertices = [&](const BoundaryPoint& a, const BoundaryPoint& b) {
        std::vector<std::size_t> out;
        if (a.edge == b.edge && a.on_edge <= b.on_edge) {
            return out;
        }
        for (std::size_t v = (a.edge + 1) % n;; v = (v + 1) % n) {
            out.push_back(v);
            if (v == b.edge) {
                return out;
            }
        }
    };
    auto forward = vertices(from, to);
    auto backward = vertices(to, from);
    std::reverse(backward.begin(), backward.end());
    const auto length = [&](const std::vector<std::size_t>& by) {
        double sum = 0;
        Vector2d at = from.at_mm;
        for (const std::size_t v : by) {
            sum += (loop[v] - at).norm();
            at = loop[v];
        }
        return sum + (to.at_mm - at).norm();
    };
    way.push_back({from.at_mm, true, from});
    for (const std::size_t v : length(forward) <= length(backward) ? forward : backward) {
        way.push_back({loop[v], true, {from.loop, v, 0, loop[v]}});
    }
    way.push_back({to.at_mm, true, to});
}

/// Straight on, and where the straight way leaves the region along the boundary to where it comes
/// back: what lies between is bounded by one loop, so leaving and coming back are on the same one.
bool TravelMap::walk(const Node& from, const Node& to, std::vector<Node>& way) const {
    auto met = inner_.meetings(from.at_mm, to.at_mm);
    std::vector<BoundaryPoint> doors;
    if (from.on_boundary && !leads_in(from, to.at_mm)) {
        doors.push_back(from.point);
    }
    const auto island = [&](const BoundaryPoint& p) { return island_of_loop_[p.loop]; };
    for (const Meeting& m : met) {
        const bool own_end =
            (from.on_boundary && m.along < kAtEnd) || (to.on_boundary && m.along > 1 - kAtEnd);
        const bool mine = doors.empty() || island(m.point) == island(doors.front());
        if (!own_end && mine) {
            doors.push_back(m.point);
        }
    }
    if (to.on_boundary && !leads_in(to, from.at_mm)) {
        doors.push_back(to.point);
    }
    if (doors.size() % 2 != 0) {
        return false;
    }
    way.push_back(from);
    for (std::size_t i = 0; i < doors.size(); i += 2) {
        if (doors[i].loop != doors[i + 1].loop) {
            return false;
        }
        follow(doors[i], doors[i + 1], way);
    }
    way.push_back(to);
    return true;
}

/// From each node on to the furthest that it sees, looked for by doubling steps.
std::vector<TravelMap::Node> TravelMap::pulled_tight(const std::vector<Node>& way) const {
    std::vector<Node> out{way.front()};
    for (std::size_t i = 0; i + 1 < way.size();) {
        std::size_t best = i + 1;
        for (std::size_t step = way.size() - 1 - i; step > 1; step /= 2) {
            if (best < i + step && sees(way[i], way[i + step])) {
                best = i + step;
                break;
            }
        }
        out.push_back(way[best]);
        i = best;
    }
    return out;
}

path::Approach TravelMap::approach(const Vector2d& from, const Vector2d& to) const {
    path::Approach out;
    const double straight = (to - from).norm();
    if (straight < kStraightOnly || surface_.empty()) {
        return out;
    }
    if (surface_.contains(from) && !surface_.crosses(from, to)) {
        out.inside = true;
        return out;
    }
    Node first;
    Node last;
    std::vector<Node> way;
    if (!brought_in(from, first) || !brought_in(to, last) || !walk(first, last, way)) {
        return out;
    }
    for (const Node& node : pulled_tight(way)) {
        const Vector2d& before = out.by.empty() ? from : out.by.back();
        if (node.at_mm != before && node.at_mm != to) {
            out.by.push_back(node.at_mm);
        }
    }
    if (length_mm(out.by, from, to) > kLongestDetour * straight + kFreeDetourMm) {
        return {};
    }
    out.inside = true;
    return out;
}

void find_approaches(const TravelMap& map, std::vector<path::Bead>& beads) {
    for (std::size_t i = 1; i < beads.size(); ++i) {
        beads[i].approach = map.approach(beads[i - 1].points.back(), beads[i].points.front());
    }
}

}  // namespace cam::fdm
