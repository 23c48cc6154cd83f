// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/orient/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace cam::orient {

namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kSameAngle = 1e-9;
constexpr double kUnturnedBonus = 1.02;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

bool left_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
    return cross(b - a, p - a) > 0;
}

/// Drops what lies strictly inside the octagon of extreme points.
std::vector<Eigen::Vector2d> outer_points(const std::vector<Eigen::Vector2d>& points) {
    std::array<std::size_t, 8> extreme{};
    std::array<Eigen::Vector2d, 8> directions;
    for (std::size_t k = 0; k < 8; ++k) {
        const double turn = kHalfTurn / 4 * static_cast<double>(k);
        directions.at(k) = {std::cos(turn), std::sin(turn)};
        for (std::size_t i = 1; i < points.size(); ++i) {
            if (directions.at(k).dot(points[i]) > directions.at(k).dot(points[extreme.at(k)])) {
                extreme.at(k) = i;
            }
        }
    }
    std::vector<Eigen::Vector2d> out;
    for (const Eigen::Vector2d& p : points) {
        bool inside = true;
        for (std::size_t k = 0; k < 8 && inside; ++k) {
            const Eigen::Vector2d& a = points[extreme.at(k)];
            const Eigen::Vector2d& b = points[extreme.at((k + 1) % 8)];
            inside = a == b || left_of(a, b, p);
        }
        if (!inside) {
            out.push_back(p);
        }
    }
    return out;
}

struct Extent {
    double size = 0;
    Eigen::Vector2d span = Eigen::Vector2d::Zero();  // from the lowest to the highest point
};

/// Extents along a direction that only turns counter-clockwise from call to call, and square to it:
/// the extreme points walk around the hull once, so that all calls together cost O(hull).
class Calipers {
  public:
    explicit Calipers(const std::vector<Eigen::Vector2d>& hull) : hull_(hull) {}

    [[nodiscard]] Extent along(const Eigen::Vector2d& x) { return between(x, 0); }

    [[nodiscard]] Extent across(const Eigen::Vector2d& x) { return between({-x.y(), x.x()}, 2); }

  private:
    Extent between(const Eigen::Vector2d& direction, std::size_t pair) {
        const Eigen::Vector2d span =
            hull_[extreme(direction, pair)] - hull_[extreme(-direction, pair + 1)];
        return {direction.dot(span), span};
    }

    std::size_t extreme(const Eigen::Vector2d& direction, std::size_t which) {
        std::size_t& at = at_.at(which);
        if (!known_.at(which)) {
            known_.at(which) = true;
            for (std::size_t i = 1; i < hull_.size(); ++i) {
                at = direction.dot(hull_[i]) > direction.dot(hull_[at]) ? i : at;
            }
        }
        for (std::size_t steps = 0; steps < hull_.size(); ++steps) {
            const std::size_t next = (at + 1) % hull_.size();
            if (direction.dot(hull_[next]) <= direction.dot(hull_[at])) {
                break;
            }
            at = next;
        }
        return at;
    }

    const std::vector<Eigen::Vector2d>& hull_;
    std::array<std::size_t, 4> at_{};
    std::array<bool, 4> known_{};
};

/// Cosine and sine that are exact at the quarter turns.
Eigen::Vector2d unit_at(double angle) {
    if (angle == 0) {
        return {1, 0};
    }
    if (angle == kHalfTurn / 2) {
        return {0, 1};
    }
    return {std::cos(angle), std::sin(angle)};
}

Turned turned(Calipers& calipers, const Eigen::Vector2d& room, double angle) {
    const Eigen::Vector2d x = unit_at(angle);
    Turned out;
    out.angle = angle;
    out.size = {calipers.along(x).size, calipers.across(x).size};
    out.ratio = std::max(out.size.x() / room.x(), out.size.y() / room.y());
    return out;
}

/// Between two critical angles the extreme points stay the same, so both extents are cosines of the
/// angle: the angle at which they fill the room equally, if there is one. a.x' / room.x = b.y' /
/// room.y.
void add_balanced(Calipers& calipers, const Eigen::Vector2d& room, double low, double high,
                  std::vector<double>& angles) {
    const Eigen::Vector2d x = unit_at((low + high) / 2);
    const Eigen::Vector2d a = calipers.along(x).span / room.x();
    const Eigen::Vector2d b = calipers.across(x).span / room.y();
    // a . (c, s) = b . (-s, c)  =>  c (a.x - b.y) + s (a.y + b.x) = 0
    double angle = std::atan2(-(a.x() - b.y()), a.y() + b.x());
    for (; angle < 0;) {
        angle += kHalfTurn;
    }
    for (; angle >= kHalfTurn;) {
        angle -= kHalfTurn;
    }
    if (angle > low && angle < high) {
        angles.push_back(angle);
    }
}

std::vector<double> critical_angles(const std::vector<Eigen::Vector2d>& hull,
                                    const Eigen::Vector2d& room) {
    std::vector<double> angles{0, kHalfTurn / 2};
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
        for (double angle :
             {std::atan2(edge.y(), edge.x()), std::atan2(edge.y(), edge.x()) + kHalfTurn / 2}) {
            angle -= kHalfTurn * std::floor(angle / kHalfTurn);
            angles.push_back(angle);
        }
    }
    std::sort(angles.begin(), angles.end());
    std::vector<double> distinct;
    for (const double angle : angles) {
        const bool quarter =
            std::abs(angle - kHalfTurn / 2) < kSameAngle || kHalfTurn - angle < kSameAngle;
        if (!quarter && (distinct.empty() || angle - distinct.back() > kSameAngle)) {
            distinct.push_back(angle);
        }
    }
    distinct.push_back(kHalfTurn / 2);
    std::sort(distinct.begin(), distinct.end());
    std::vector<double> out = distinct;
    Calipers calipers(hull);
    for (std::size_t i = 0; i < distinct.size(); ++i) {
        add_balanced(calipers, room, distinct[i],
                     i + 1 < distinct.size() ? distinct[i + 1] : kHalfTurn, out);
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

std::vector<Eigen::Vector2d> convex_hull(const std::vector<Eigen::Vector2d>& points) {
    if (points.size() < 3) {
        return points;
    }
    std::vector<Eigen::Vector2d> sorted = outer_points(points);
    std::sort(sorted.begin(), sorted.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
    });
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    std::vector<Eigen::Vector2d> hull;
    const auto sweep = [&](auto first, auto last) {
        const std::size_t floor = hull.size();
        for (auto it = first; it != last; ++it) {
            while (hull.size() >= floor + 2 && !left_of(hull[hull.size() - 2], hull.back(), *it)) {
                hull.pop_back();
            }
            hull.push_back(*it);
        }
        hull.pop_back();  // the end begins the other chain
    };
    if (sorted.size() < 3) {
        return sorted;
    }
    sweep(sorted.begin(), sorted.end());
    sweep(sorted.rbegin(), sorted.rend());
    return hull;
}

double polygon_area(const std::vector<Eigen::Vector2d>& polygon) {
    double area = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        area += cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]) / 2;
    }
    return area;
}

bool holds(const std::vector<Eigen::Vector2d>& hull, const Eigen::Vector2d& point) {
    for (std::size_t i = 0; i < hull.size(); ++i) {
        if (!left_of(hull[i], hull[(i + 1) % hull.size()], point)) {
            return false;
        }
    }
    return hull.size() >= 3;
}

Turned best_turn(const std::vector<Eigen::Vector2d>& hull, const Eigen::Vector2d& room) {
    if (hull.empty()) {
        return {};
    }
    Turned smallest;
    Turned loosest;
    bool any = false;
    bool any_fits = false;
    Calipers calipers(hull);
    for (const double angle : critical_angles(hull, room)) {
        const Turned now = turned(calipers, room, angle);
        if (!any || now.ratio < loosest.ratio * (1 - kSameAngle)) {
            loosest = now;
        }
        if (now.fits() &&
            (!any_fits || now.size.prod() < smallest.size.prod() * (1 - kSameAngle))) {
            smallest = now;
            any_fits = true;
        }
        any = true;
    }
    if (!any_fits) {
        return loosest;
    }
    Calipers straight_on(hull);
    for (const double angle : {0.0, kHalfTurn / 2}) {
        Turned straight = turned(straight_on, room, angle);
        if (straight.fits() && straight.size.prod() <= kUnturnedBonus * smallest.size.prod()) {
            return straight;
        }
    }
    return smallest;
}

}  // namespace cam::orient
