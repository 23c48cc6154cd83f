// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/boundary.h"
#include "decomp/solid/strips.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace decomp::solid {

namespace {

constexpr std::size_t kFewestBands = 3;
constexpr int kRounds = 8;
constexpr double kEndOfWidth = 1e-3;  ///< points within it belong to one rim of a band

using Point2s = std::vector<Eigen::Vector2d>;

/// A cone or cylinder as it is seen in a half plane through an axis: radius and height.
struct Band {
    Point2s low;  ///< the points of its rims
    Point2s high;
    Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< their means
    Eigen::Vector2d to = Eigen::Vector2d::Zero();
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< out of the solid
};

/// The half plane through an axis.
struct HalfPlane {
    AxisLine line;

    [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector3d& p) const {
        const double height = line.axis.dot(p - line.origin);
        return {(p - line.origin - height * line.axis).norm(), height};
    }
};

/// A section of a torus while its bands are gathered.
struct Tube {
    HalfPlane plane;
    CircleFit circle;
    bool outward = true;
    double within_mm = 0;
    double reach_mm = 0;
    double widest_mm = 0;
};

/// Bands about one axis whose rims lie on one circle of the half plane: what strips are to a
/// cylinder, they are to a torus.
class TorusFinder {
  public:
    TorusFinder(Facets& facets, const RegionOptions& options)
        : facets_(facets), options_(options), strips_(facets, options) {}

    void find() {
        bands_ = facets_.curved_facets();
        beside_.resize(bands_.size());
        for (std::uint32_t b = 0; b < bands_.size(); ++b) {
            for (const std::uint32_t r : facets_.curved_neighbours_of(bands_[b])) {
                if (number(r) != b) {
                    beside_[b].push_back(number(r));
                }
            }
        }
        used_.assign(bands_.size(), false);
        for (const auto& [a, b] : seeds()) {
            if (!used_[a] && !used_[b]) {
                try_pair(a, b);
            }
        }
    }

  private:
    [[nodiscard]] std::uint32_t number(std::uint32_t region) const {
        return region - facets_.flat_count();
    }

    [[nodiscard]] const Region& region(std::uint32_t band) const {
        return facets_.region(band + facets_.flat_count());
    }

    [[nodiscard]] bool is_about(std::uint32_t band, const AxisLine& line) const {
        const AxisLine own = axis_of(region(band).surface);
        const double near_mm =
            std::max(10 * options_.planar_mm,
                     std::min(options_.tolerance_mm, 0.1 * region(band).sagitta_mm));
        return own.axis.cross(line.axis).norm() < kAlmost &&
               (own.origin - line.origin).cross(line.axis).norm() <=
                   near_mm + kAlmost * (own.origin - line.origin).norm();
    }

    /// Pairs of neighbours about one axis, largest first.
    [[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> seeds() const {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
        for (std::uint32_t a = 0; a < beside_.size(); ++a) {
            for (const std::uint32_t b : beside_[a]) {
                if (a < b && is_about(b, axis_of(region(a).surface))) {
                    pairs.emplace_back(a, b);
                }
            }
        }
        const auto area = [&](const auto& pair) {
            return std::min(region(pair.first).area_mm2, region(pair.second).area_mm2);
        };
        std::sort(pairs.begin(), pairs.end());
        std::stable_sort(pairs.begin(), pairs.end(),
                         [&](const auto& a, const auto& b) { return area(a) > area(b); });
        return pairs;
    }

    /// The axis of these bands: that of a cylinder among them or beside them, which has more to
    /// hold on to, otherwise that of the largest.
    [[nodiscard]] AxisLine axis_for(const std::vector<std::uint32_t>& found) const {
        const AxisLine own = axis_of(region(found[0]).surface);
        std::optional<std::uint32_t> cylinder;
        std::uint32_t largest = found[0];
        for (const std::uint32_t b : found) {
            largest = region(b).area_mm2 > region(largest).area_mm2 ? b : largest;
            std::vector<std::uint32_t> near = beside_.at(b);
            near.push_back(b);
            for (const std::uint32_t n : near) {
                if (std::holds_alternative<CylinderSurface>(region(n).surface) &&
                    is_about(n, own) &&
                    (!cylinder || region(n).area_mm2 > region(*cylinder).area_mm2)) {
                    cylinder = n;
                }
            }
        }
        AxisLine line = axis_of(region(cylinder.value_or(largest)).surface);
        line.axis = line.axis.dot(own.axis) < 0 ? Eigen::Vector3d(-line.axis) : line.axis;
        return line;
    }

    /// Nothing where the band is not seen as a straight line with two ends.
    [[nodiscard]] std::optional<Band> seen(std::uint32_t b, const HalfPlane& plane) const {
        Band band;
        const Region& own = region(b);
        const Eigen::Vector3d& any = facets_.point(facets_[bands_[b][0]].points[0]);
        const Eigen::Vector2d at = plane(any);
        const Eigen::Vector3d normal = normal_at(own.surface, any);
        const Eigen::Vector3d out = any - plane.line.origin;
        const double across =
            normal.dot((out - out.dot(plane.line.axis) * plane.line.axis).normalized());
        band.normal = Eigen::Vector2d(across, normal.dot(plane.line.axis)).normalized() *
                      (own.outward ? 1 : -1);
        const Eigen::Vector2d along(-band.normal.y(), band.normal.x());
        const std::vector<std::uint32_t> numbers = facets_.points_of(bands_[b]);
        Point2s points;
        points.reserve(numbers.size());
        double low = INFINITY;
        double high = -low;
        for (const std::uint32_t p : numbers) {
            points.push_back(plane(facets_.point(p)));
            low = std::min(low, along.dot(points.back() - at));
            high = std::max(high, along.dot(points.back() - at));
        }
        const double near = std::max(10 * options_.planar_mm, kEndOfWidth * (high - low));
        for (const Eigen::Vector2d& q : points) {
            if (along.dot(q - at) <= low + near) {
                band.low.push_back(q);
                band.from += q;
            } else if (along.dot(q - at) >= high - near) {
                band.high.push_back(q);
                band.to += q;
            }
        }
        if (band.low.empty() || band.high.empty()) {
            return std::nullopt;
        }
        band.from /= static_cast<double>(band.low.size());
        band.to /= static_cast<double>(band.high.size());
        return band;
    }

    [[nodiscard]] std::optional<Tube> tube_from(std::uint32_t a, std::uint32_t b) const {
        Tube tube;
        tube.plane = {axis_for({a, b})};
        const auto of_a = seen(a, tube.plane);
        const auto of_b = seen(b, tube.plane);
        if (!of_a || !of_b) {
            return std::nullopt;
        }
        // Both run the same way round the solid: one ends where the other begins.
        const bool before = (of_a->to - of_b->from).norm() < (of_a->from - of_b->to).norm();
        const Band& first = before ? *of_a : *of_b;
        const Band& second = before ? *of_b : *of_a;
        const auto circle = circle_through(first.from, (first.to + second.from) / 2, second.to);
        const double width_a = (first.from - first.to).norm();
        const double width_b = (second.from - second.to).norm();
        if (!circle || (first.to - second.from).norm() > options_.tolerance_mm ||
            width_a > kUneven * width_b || width_b > kUneven * width_a) {
            return std::nullopt;
        }
        tube.circle = *circle;
        tube.widest_mm = 1.5 * std::max(width_a, width_b);
        const double half = std::max(width_a, width_b) / (2 * circle->radius);
        tube.reach_mm =
            strips_.reach_mm(circle->radius * (1 - std::sqrt(std::max(0.0, 1 - half * half))));
        tube.within_mm = tube.reach_mm;
        tube.outward = first.normal.dot((first.from + first.to) / 2 - circle->centre) > 0;
        return tube;
    }

    [[nodiscard]] static double off(const CircleFit& circle, const Eigen::Vector2d& q) {
        return std::abs((q - circle.centre).norm() - circle.radius);
    }

    [[nodiscard]] bool chords(std::uint32_t b, const Tube& tube) const {
        if (used_[b] || !is_about(b, tube.plane.line)) {
            return false;
        }
        const auto band = seen(b, tube.plane);
        if (!band) {
            return false;
        }
        const double width = (band->to - band->from).norm();
        const Eigen::Vector2d middle = (band->to + band->from) / 2 - tube.circle.centre;
        return off(tube.circle, band->from) <= tube.within_mm &&
               off(tube.circle, band->to) <= tube.within_mm && width <= tube.widest_mm &&
               width <= 2 * tube.circle.radius * std::sin(kWidestStep / 2) &&
               (band->normal.dot(middle) > 0) == tube.outward;
    }

    [[nodiscard]] std::vector<std::uint32_t> gather(std::uint32_t seed, const Tube& tube) const {
        std::vector<std::uint32_t> found;
        if (!chords(seed, tube)) {
            return found;
        }
        found.push_back(seed);
        for (std::size_t i = 0; i < found.size(); ++i) {
            for (const std::uint32_t n : beside_.at(found[i])) {
                if (std::find(found.begin(), found.end(), n) == found.end() && chords(n, tube)) {
                    found.push_back(n);
                }
            }
        }
        std::sort(found.begin(), found.end());
        return found;
    }

    [[nodiscard]] std::vector<std::uint32_t> facets_of(
        const std::vector<std::uint32_t>& found) const {
        std::vector<std::uint32_t> all;
        for (const std::uint32_t b : found) {
            all.insert(all.end(), bands_[b].begin(), bands_[b].end());
        }
        return all;
    }

    [[nodiscard]] double sagitta_of(const std::vector<std::uint32_t>& found,
                                    const Tube& tube) const {
        double sagitta = 0;
        for (const std::uint32_t b : found) {
            if (const auto band = seen(b, tube.plane)) {
                const double half = (band->to - band->from).norm() / 2 / tube.circle.radius;
                sagitta = std::max(
                    sagitta, tube.circle.radius * (1 - std::sqrt(std::max(0.0, 1 - half * half))));
            }
        }
        return sagitta;
    }

    /// The planes and cylinders around that the torus touches, as lines of the half plane.
    [[nodiscard]] std::vector<TangentLine> tangents_of(const std::vector<std::uint32_t>& found,
                                                       const Tube& tube, double near_mm) const {
        std::vector<TangentLine> touched;
        const double side = tube.outward ? 1 : -1;
        const auto add = [&](const Eigen::Vector2d& normal, double offset) {
            const TangentLine line{normal, side, offset};
            const double gap = normal.dot(tube.circle.centre) + side * tube.circle.radius - offset;
            const bool other = touched.empty() || (touched.size() == 1 &&
                                                   std::abs(touched[0].normal.dot(normal)) < 0.9);
            if (std::abs(gap) <= near_mm && other) {
                touched.push_back(line);
            }
        };
        const std::vector<std::uint32_t> facets = facets_of(found);
        for (const std::uint32_t g : facets_.flat_around(facets)) {
            const PlaneSurface& plane = facets_.plane(g);
            const double along = plane.normal.dot(tube.plane.line.axis);
            if (1 - std::abs(along) < kAlmost * kAlmost) {
                add({0, along > 0 ? 1 : -1},
                    plane.offset_mm - plane.normal.dot(tube.plane.line.origin));
            }
        }
        for (const std::uint32_t r : facets_.curved_neighbours_of(facets)) {
            const auto* cylinder = std::get_if<CylinderSurface>(&facets_.region(r).surface);
            if (cylinder != nullptr && is_about(number(r), tube.plane.line)) {
                const double way = facets_.region(r).outward ? 1 : -1;
                add({way, 0}, way * cylinder->radius_mm);
            }
        }
        return touched;
    }

    /// Fillets beside the torus have its radius, and it has theirs: their mean.
    [[nodiscard]] std::optional<double> fillet_radius(const std::vector<std::uint32_t>& found,
                                                      const Tube& tube, double near_mm) const {
        double sum = 0;
        int count = 0;
        for (const std::uint32_t r : facets_.curved_neighbours_of(facets_of(found))) {
            const auto* cylinder = std::get_if<CylinderSurface>(&facets_.region(r).surface);
            if (cylinder != nullptr &&
                std::abs(cylinder->axis.dot(tube.plane.line.axis)) < kAlmost &&
                std::abs(cylinder->radius_mm - tube.circle.radius) <= near_mm) {
                sum += cylinder->radius_mm;
                ++count;
            }
        }
        return count == 0 ? std::nullopt : std::optional(sum / count);
    }

    double refit(const std::vector<std::uint32_t>& found, Tube& tube) const {
        const Eigen::Vector3d centre =
            tube.plane.line.origin + tube.circle.centre.y() * tube.plane.line.axis;
        tube.plane.line = axis_for(found);
        tube.circle.centre.y() = tube.plane.line.axis.dot(centre - tube.plane.line.origin);
        Point2s points;
        for (const std::uint32_t b : found) {
            if (const auto band = seen(b, tube.plane)) {
                points.insert(points.end(), band->low.begin(), band->low.end());
                points.insert(points.end(), band->high.begin(), band->high.end());
            }
        }
        const double near_mm =
            std::max(10 * options_.planar_mm,
                     std::min(options_.tolerance_mm, 0.1 * sagitta_of(found, tube)));
        const std::vector<TangentLine> touched = tangents_of(found, tube, near_mm);
        double median = 0;
        for (int round = 0; round < 4; ++round) {
            std::vector<double> distance;
            distance.reserve(points.size());
            for (const Eigen::Vector2d& q : points) {
                distance.push_back(off(tube.circle, q));
            }
            const Nearest nearest = nearest_of(distance, options_.planar_mm);
            Point2s near;
            near.reserve(nearest.near.size());
            for (const std::size_t i : nearest.near) {
                near.push_back(points[i]);
            }
            tube.circle = fit_circle(near, tube.circle, touched);
            median = nearest.median;
        }
        const auto radius = fillet_radius(found, tube, near_mm);
        if (radius && touched.size() == 2) {
            Eigen::Matrix2d lines;
            lines << touched[0].normal.transpose(), touched[1].normal.transpose();
            tube.circle = {
                lines.inverse() * Eigen::Vector2d(touched[0].offset - touched[0].side * *radius,
                                                  touched[1].offset - touched[1].side * *radius),
                *radius};
        }
        return median;
    }

    void try_pair(std::uint32_t a, std::uint32_t b) {
        auto tube = tube_from(a, b);
        if (!tube) {
            return;
        }
        std::vector<std::uint32_t> found = gather(a, *tube);
        double median = 0;
        for (int round = 0; round < kRounds && found.size() >= kFewestBands; ++round) {
            median = refit(found, *tube);
            tube->within_mm =
                std::min(tube->reach_mm, std::max(5 * median, 3 * options_.planar_mm));
            std::vector<std::uint32_t> again = gather(a, *tube);
            const bool same = again == found;
            found = std::move(again);
            if (same && round > 0) {
                break;
            }
        }
        const double sagitta = sagitta_of(found, *tube);
        if (found.size() < kFewestBands || !(median <= strips_.rest_mm(sagitta)) ||
            tube->circle.centre.x() <= tube->circle.radius) {
            return;  // it would pass through itself
        }
        double behind = 0;
        for (const std::uint32_t f : found) {
            used_[f] = true;
            behind = std::max(behind, region(f).sagitta_mm);
        }
        const AxisLine& line = tube->plane.line;
        facets_.keep(facets_of(found),
                     TorusSurface{line.origin + tube->circle.centre.y() * line.axis, line.axis,
                                  tube->circle.centre.x(), tube->circle.radius},
                     tube->outward, behind + sagitta);
    }

    Facets& facets_;
    const RegionOptions& options_;
    Strips strips_;
    std::vector<std::vector<std::uint32_t>> bands_;  ///< the facets of each curved region
    std::vector<std::vector<std::uint32_t>> beside_;
    std::vector<bool> used_;
};

}  // namespace

void find_tori(Facets& facets, const RegionOptions& options) {
    TorusFinder(facets, options).find();
}

}  // namespace decomp::solid
