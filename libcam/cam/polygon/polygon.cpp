// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/polygon/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace cam::polygon {

namespace {

constexpr double kNanometresPerMm = 1e6;

/// Twice the signed area of (a, b, c), nm^2; exact below 1 m.
double cross(const Point& a, const Point& b, const Point& c) {
    return static_cast<double>(b.x - a.x) * static_cast<double>(c.y - a.y) -
           static_cast<double>(b.y - a.y) * static_cast<double>(c.x - a.x);
}

double squared_distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const auto dx = static_cast<double>(b.x - a.x);
    const auto dy = static_cast<double>(b.y - a.y);
    const auto px = static_cast<double>(p.x - a.x);
    const auto py = static_cast<double>(p.y - a.y);
    const double length2 = dx * dx + dy * dy;
    const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
    const double ex = px - t * dx;
    const double ey = py - t * dy;
    return ex * ex + ey * ey;
}

/// Marks the points to keep between two kept ones of the cyclic loop. Iterative: loops may be long.
void keep_far_points(const Path& loop, std::size_t first, std::size_t last, double tolerance2,
                     std::vector<char>& keep) {
    std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        std::size_t farthest = from;
        double most = tolerance2;
        for (std::size_t i = from + 1; i < to; ++i) {
            const double d =
                squared_distance_to_segment(loop[i], loop[from], loop[to % loop.size()]);
            if (d > most) {
                most = d;
                farthest = i;
            }
        }
        if (farthest != from) {
            keep[farthest] = 1;
            open.emplace_back(from, farthest);
            open.emplace_back(farthest, to);
        }
    }
}

bool lexicographic(const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

}  // namespace

Paths Island::loops() const {
    Paths out{outer};
    out.insert(out.end(), holes.begin(), holes.end());
    return out;
}

std::int64_t nanometres(double length_mm) { return std::llround(length_mm * kNanometresPerMm); }

Point from_mm(const Eigen::Vector2d& point_mm) {
    return {nanometres(point_mm.x()), nanometres(point_mm.y())};
}

double to_mm(std::int64_t length) { return static_cast<double>(length) / kNanometresPerMm; }

Eigen::Vector2d to_mm(const Point& point) { return {to_mm(point.x), to_mm(point.y)}; }

double area_mm2(const Path& loop) {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        twice += cross(loop[0], loop[i], loop[i + 1]);
    }
    return twice / (2 * kNanometresPerMm * kNanometresPerMm);
}

double area_mm2(const Paths& region) {
    return std::accumulate(region.begin(), region.end(), 0.0,
                           [](double sum, const Path& loop) { return sum + area_mm2(loop); });
}

double perimeter_mm(const Path& loop) {
    double length = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        length += (to_mm(loop[(i + 1) % loop.size()]) - to_mm(loop[i])).norm();
    }
    return length;
}

Box bounds(const Path& path) {
    if (path.empty()) {
        return {};
    }
    Box box{path.front(), path.front()};
    for (const Point& p : path) {
        box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y)};
        box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y)};
    }
    return box;
}

Box bounds(const Paths& paths) {
    Box all;
    for (const Path& path : paths) {
        const Box box = bounds(path);
        if (box.empty()) {
            continue;
        }
        if (all.empty()) {
            all = box;
            continue;
        }
        all.min = {std::min(all.min.x, box.min.x), std::min(all.min.y, box.min.y)};
        all.max = {std::max(all.max.x, box.max.x), std::max(all.max.y, box.max.y)};
    }
    return all;
}

bool touches(const Box& a, const Box& b, std::int64_t reach) {
    return !a.empty() && !b.empty() && a.min.x <= b.max.x + reach && b.min.x <= a.max.x + reach &&
           a.min.y <= b.max.y + reach && b.min.y <= a.max.y + reach;
}

bool contains(const Paths& region, const Point& point) {
    bool inside = false;
    for (const Path& loop : region) {
        for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
            const Point& a = loop[j];
            const Point& b = loop[i];
            const double side = cross(a, b, point);
            if (side == 0 && std::min(a.x, b.x) <= point.x && point.x <= std::max(a.x, b.x) &&
                std::min(a.y, b.y) <= point.y && point.y <= std::max(a.y, b.y)) {
                return true;
            }
            if ((a.y > point.y) != (b.y > point.y) && (side > 0) == (b.y > a.y)) {
                inside = !inside;
            }
        }
    }
    return inside;
}

std::vector<Island> islands(const Paths& region) {
    std::vector<Island> out;
    std::vector<Box> boxes;
    std::vector<double> areas;
    for (const Path& loop : region) {
        const double area = area_mm2(loop);
        if (area > 0) {
            out.push_back({loop, {}});
            boxes.push_back(bounds(loop));
            areas.push_back(area);
        }
    }
    for (const Path& loop : region) {
        if (loop.empty() || area_mm2(loop) >= 0) {
            continue;
        }
        // The smallest outer loop around the hole is the one it belongs to. Loops may share
        // vertices, so the majority of the hole's points decides.
        const Box box = bounds(loop);
        std::size_t owner = out.size();
        for (std::size_t i = 0; i < out.size(); ++i) {
            if (!touches(box, boxes[i]) || (owner < out.size() && areas[i] >= areas[owner])) {
                continue;
            }
            const auto inside = std::count_if(loop.begin(), loop.end(), [&](const Point& p) {
                return contains({out[i].outer}, p);
            });
            if (2 * static_cast<std::size_t>(inside) > loop.size()) {
                owner = i;
            }
        }
        if (owner < out.size()) {
            out[owner].holes.push_back(loop);
        }
    }
    return out;
}

Path simplified(const Path& loop, double tolerance_mm) {
    if (loop.size() < 3) {
        return {};
    }
    const std::size_t n = loop.size();
    const double tolerance = tolerance_mm * kNanometresPerMm;
    // Two anchors that the shape itself defines: the lowest point and the one farthest from it.
    const auto start = static_cast<std::size_t>(
        std::min_element(loop.begin(), loop.end(), lexicographic) - loop.begin());
    Path turned(loop.begin() + static_cast<std::ptrdiff_t>(start), loop.end());
    turned.insert(turned.end(), loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(start));
    std::size_t far = 0;
    double most = 0;
    for (std::size_t i = 1; i < n; ++i) {
        const double d = squared_distance_to_segment(turned[i], turned[0], turned[0]);
        if (d > most) {
            most = d;
            far = i;
        }
    }
    if (far == 0) {
        return {};
    }
    std::vector<char> keep(n, 0);
    keep[0] = 1;
    keep[far] = 1;
    keep_far_points(turned, 0, far, tolerance * tolerance, keep);
    keep_far_points(turned, far, n, tolerance * tolerance, keep);
    Path out;
    for (std::size_t i = 0; i < n; ++i) {
        if (keep[i] != 0) {
            out.push_back(turned[i]);
        }
    }
    return out.size() < 3 ? Path{} : out;
}

Paths simplified(const Paths& region, double tolerance_mm) {
    Paths out;
    out.reserve(region.size());
    for (const Path& loop : region) {
        Path simple = simplified(loop, tolerance_mm);
        if (!simple.empty()) {
            out.push_back(std::move(simple));
        }
    }
    return out;
}

Path convex_hull(const Paths& paths) {
    Path points;
    for (const Path& path : paths) {
        points.insert(points.end(), path.begin(), path.end());
    }
    std::sort(points.begin(), points.end(), lexicographic);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) {
        return points;
    }
    Path hull;
    const auto add_chain = [&hull](const Path& chain) {
        const std::size_t base = hull.size();
        for (const Point& p : chain) {
            while (hull.size() >= base + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0) {
                hull.pop_back();
            }
            hull.push_back(p);
        }
        hull.pop_back();
    };
    add_chain(points);
    std::reverse(points.begin(), points.end());
    add_chain(points);
    return hull;
}

Paths translated(const Paths& paths, const Point& by) {
    Paths out = paths;
    for (Path& path : out) {
        for (Point& p : path) {
            p.x += by.x;
            p.y += by.y;
        }
    }
    return out;
}

}  // namespace cam::polygon
