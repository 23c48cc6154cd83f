// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/strips.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace decomp::solid {

namespace {

constexpr int kFewestStrips = 3;
constexpr double kRestOfSagitta =
    0.002;                             ///< points deviate by no more than this share of the sagitta
constexpr double kSideOfWidth = 1e-3;  ///< points within it belong to one side of a strip
constexpr double kFloatNoise = 0.3;    ///< of planar_mm: what rounding to float leaves
constexpr int kRounds = 8;
constexpr double kBesideApex = 1e-6;  ///< of the height
constexpr double kFarAway = 1e6;      ///< of the height
constexpr double kOffRulings = 0.1;   ///< sine of the angle between a strip and the rulings

}  // namespace

Rulings::Rulings(const Eigen::Vector3d& axis)
    : axis_(axis), u_(reference_direction(axis)), v_(axis.cross(u_)) {}

Rulings Rulings::parallel(const Eigen::Vector3d& axis) { return Rulings(axis); }

Rulings Rulings::through(const ConeSurface& cone, double height_mm, double near_mm) {
    Rulings rulings(cone.axis);
    rulings.apex_ = cone.apex;
    rulings.height_ = height_mm;
    rulings.near_ = near_mm;
    rulings.slope_ = std::cos(cone.half_angle);
    return rulings;
}

Eigen::Vector2d Rulings::operator()(const Eigen::Vector3d& p) const {
    if (height_ == 0) {
        return across(p);
    }
    const double above = axis_.dot(p - apex_);
    if (above <= kBesideApex * height_) {
        return Eigen::Vector2d::Constant(kFarAway * height_);
    }
    return across(p - apex_) * (height_ / above);
}

Eigen::Vector3d Rulings::direction(const Eigen::Vector3d& p) const {
    return height_ == 0 ? axis_ : (p - apex_).normalized();
}

double Rulings::magnified(const Eigen::Vector3d& p) const {
    return height_ == 0 ? 1 : height_ / (axis_.dot(p - apex_) * slope_);
}

bool Rulings::is_apex(const Eigen::Vector3d& p) const {
    return height_ != 0 && (p - apex_).norm() <= near_;
}

std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> Strips::sides_of(
    std::uint32_t f, const Rulings& rulings) const {
    const Facet& facet = facets_[f];
    const Eigen::Vector2d normal = rulings.across(facet.normal);
    const Eigen::Vector2d along = Eigen::Vector2d(-normal.y(), normal.x()).normalized();
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    int apexes = 0;
    for (const std::uint32_t p : facet.points) {
        if (rulings.is_apex(facets_.point(p))) {
            ++apexes;
            continue;
        }
        const double s = along.dot(rulings(facets_.point(p)));
        low = std::min(low, s);
        high = std::max(high, s);
    }
    std::pair<Eigen::Vector2d, Eigen::Vector2d> sides{Eigen::Vector2d::Zero(),
                                                      Eigen::Vector2d::Zero()};
    int at_low = 0;
    int at_high = 0;
    for (const std::uint32_t p : facet.points) {
        if (rulings.is_apex(facets_.point(p))) {
            continue;
        }
        const Eigen::Vector2d q = rulings(facets_.point(p));
        const double near = std::max(10 * options_.planar_mm * rulings.magnified(facets_.point(p)),
                                     kSideOfWidth * (high - low));
        if (along.dot(q) <= low + near) {
            sides.first += q;
            ++at_low;
        } else if (along.dot(q) >= high - near) {
            sides.second += q;
            ++at_high;
        }
    }
    if (at_low + apexes < 2 || at_high + apexes < 2 || at_low == 0 || at_high == 0) {
        return std::nullopt;
    }
    sides.first /= at_low;
    sides.second /= at_high;
    return sides;
}

/// A facet chords the surface: its extreme points lie on it, the others on the chord between them.
bool Strips::chords(std::uint32_t f, const Guess& guess) const {
    const Facet& facet = facets_[f];
    const Rulings& rulings = guess.rulings;
    const Eigen::Vector2d normal = rulings.across(facet.normal);
    const Eigen::Vector2d along = Eigen::Vector2d(-normal.y(), normal.x()).normalized();
    std::optional<Eigen::Vector3d> low;
    std::optional<Eigen::Vector3d> high;
    for (const std::uint32_t p : facet.points) {
        const Eigen::Vector3d& x = facets_.point(p);
        if (rulings.is_apex(x)) {
            continue;
        }
        low = !low || along.dot(rulings(x)) < along.dot(rulings(*low)) ? x : low;
        high = !high || along.dot(rulings(x)) > along.dot(rulings(*high)) ? x : high;
    }
    if (!low || std::abs(facet.normal.dot(rulings.direction(*low))) > kOffRulings) {
        return false;
    }
    const Eigen::Vector2d from = rulings(*low);
    const Eigen::Vector2d to = rulings(*high);
    const auto off_circle = [&](const Eigen::Vector2d& p) {
        return std::abs((p - guess.circle.centre).norm() - guess.circle.radius);
    };
    const Eigen::Vector2d chord = to - from;
    const Eigen::Vector2d middle = (from + to) / 2 - guess.circle.centre;
    if (off_circle(from) > guess.within_mm * rulings.magnified(*low) ||
        off_circle(to) > guess.within_mm * rulings.magnified(*high) ||
        chord.norm() > guess.widest_mm ||
        chord.norm() > 2 * guess.circle.radius * std::sin(kWidestStep / 2) ||
        (normal.dot(middle) > 0) != guess.outward) {
        return false;
    }
    const Eigen::Vector2d side = Eigen::Vector2d(-chord.y(), chord.x()).normalized();
    return std::all_of(facet.points.begin(), facet.points.end(), [&](std::uint32_t p) {
        const Eigen::Vector3d& x = facets_.point(p);
        if (rulings.is_apex(x)) {
            return true;
        }
        const Eigen::Vector2d q = rulings(x);
        const double near = guess.within_mm * rulings.magnified(x);
        return std::abs(side.dot(q - from)) <= near || off_circle(q) <= near;
    });
}

std::optional<Chorded> Strips::settle(
    Guess guess, std::uint32_t seed,
    const std::function<double(const std::vector<std::uint32_t>&, Guess&)>& refit) {
    const auto gather = [&] {
        return facets_.gather(seed, [&](std::uint32_t f) { return chords(f, guess); });
    };
    std::vector<std::uint32_t> found = gather();
    double median = 0;
    for (int round = 0; round < kRounds; ++round) {
        if (found.size() < kFewestStrips) {
            return std::nullopt;
        }
        median = refit(found, guess);
        guess.within_mm = std::min(guess.reach_mm, std::max(5 * median, 3 * options_.planar_mm));
        std::vector<std::uint32_t> again = gather();
        const bool same = again == found;
        found = std::move(again);
        if (same && round > 0) {
            break;
        }
    }
    if (found.size() < kFewestStrips) {
        return std::nullopt;
    }
    const double sagitta_mm = sagitta_of(found, guess);
    if (!(median <= rest_mm(sagitta_mm)) || strips_among(found, guess) < kFewestStrips) {
        return std::nullopt;
    }
    return Chorded{std::move(found), guess, sagitta_mm};
}

double Strips::sagitta_of(const std::vector<std::uint32_t>& found, const Guess& guess) const {
    double nearest = guess.circle.radius;
    for (const std::uint32_t f : found) {
        const Eigen::Vector2d normal = guess.rulings.across(facets_[f].normal).normalized();
        const auto any =
            std::find_if(facets_[f].points.begin(), facets_[f].points.end(),
                         [&](std::uint32_t p) { return !guess.rulings.is_apex(facets_.point(p)); });
        nearest = std::min(nearest, std::abs(normal.dot(guess.rulings(facets_.point(*any)) -
                                                        guess.circle.centre)));
    }
    return (guess.circle.radius - nearest) / guess.rulings.magnified();
}

double Strips::rest_mm(double sagitta_mm) const {
    return std::max(kFloatNoise * options_.planar_mm, kRestOfSagitta * sagitta_mm);
}

double Strips::reach_mm(double sagitta_mm) const {
    return std::min(options_.tolerance_mm,
                    std::max(20 * options_.planar_mm, kSeedOfSagitta * sagitta_mm));
}

/// Facets with two sides along the rulings, by different directions.
int Strips::strips_among(const std::vector<std::uint32_t>& found, const Guess& guess) const {
    int strips = 0;
    for (const std::uint32_t f : found) {
        const bool pointed =
            std::any_of(facets_[f].points.begin(), facets_[f].points.end(),
                        [&](std::uint32_t p) { return guess.rulings.is_apex(facets_.point(p)); });
        strips += (facets_.is_flat(f) || pointed) && sides_of(f, guess.rulings) ? 1 : 0;
    }
    return strips;
}

Nearest nearest_of(const std::vector<double>& off, double planar_mm) {
    std::vector<double> sorted = off;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    Nearest nearest{*middle, {}};
    for (std::size_t i = 0; i < off.size(); ++i) {
        if (off[i] <= 3 * nearest.median + planar_mm) {
            nearest.near.push_back(i);
        }
    }
    return nearest;
}

}  // namespace decomp::solid
