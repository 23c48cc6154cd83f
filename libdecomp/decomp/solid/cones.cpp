// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/boundary.h"
#include "decomp/solid/cone_fit.h"
#include "decomp/solid/strips.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

namespace decomp::solid {

namespace {

constexpr std::size_t kSeedStrips = 8;  ///< a cone is guessed from so many, or fewer
constexpr std::size_t kFewestStrips = 3;
constexpr std::size_t kFewestRound = 12;                    ///< of a fan round its apex
constexpr double kSlimmest = 0.1 * std::numbers::pi / 180;  ///< half angle; below it, a cylinder
constexpr double kFlattest = 89 * std::numbers::pi / 180;   ///< above it, a plane
constexpr double kAtApex = 5;                               ///< of planar_mm
constexpr double kTaper = 10;  ///< of planar_mm: between the radii of a cone

using Chain = std::deque<std::uint32_t>;

class ConeFinder {
  public:
    ConeFinder(Facets& facets, const RegionOptions& options)
        : facets_(facets), options_(options), strips_(facets, options) {}

    void find() {
        for (const auto& [f, g] : facets_.pairs(kNarrowestStep, kWidestStep)) {
            if (!facets_.usable(f) || !facets_.usable(g)) {
                continue;
            }
            const Chain chain = chain_from(f, g);
            // Its ends may be strips of other surfaces, of a fillet for instance.
            for (const auto& few : parts_of(chain, f, g)) {
                const auto cone = cone_of(few);
                if (cone && try_cone(*cone, few)) {
                    break;
                }
            }
        }
        for (const Fan& fan : facets_.fans(kFewestRound)) {
            if (std::all_of(fan.facets.begin(), fan.facets.end(),
                            [&](std::uint32_t f) { return facets_.usable(f); })) {
                if (const auto cone = cone_of(fan)) {
                    try_cone(*cone, fan.facets);
                }
            }
        }
    }

    /// Cones in a row with cylinders and each other get one axis: that of the cylinders, otherwise
    /// of the largest.
    void align_all() const {
        const std::vector<std::vector<std::uint32_t>> curved = facets_.curved_facets();
        std::vector<bool> done(curved.size(), false);
        for (const std::uint32_t leader : leaders(curved.size())) {
            std::vector<std::uint32_t> row;
            if (!done[leader - facets_.flat_count()]) {
                row.push_back(leader);
                done[leader - facets_.flat_count()] = true;
            }
            for (std::size_t i = 0; i < row.size(); ++i) {
                align_beside(row[i], curved, done, row);
            }
        }
    }

  private:
    [[nodiscard]] bool is_cylinder(std::uint32_t r) const {
        return std::holds_alternative<CylinderSurface>(facets_.region(r).surface);
    }

    /// All curved regions: cylinders first, then by area.
    [[nodiscard]] std::vector<std::uint32_t> leaders(std::size_t count) const {
        std::vector<std::uint32_t> order(count);
        std::iota(order.begin(), order.end(), facets_.flat_count());
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return is_cylinder(a) != is_cylinder(b)
                       ? is_cylinder(a)
                       : facets_.region(a).area_mm2 > facets_.region(b).area_mm2;
        });
        return order;
    }

    /// Lays the cones beside a region on its axis and adds them to the row.
    void align_beside(std::uint32_t region, const std::vector<std::vector<std::uint32_t>>& curved,
                      std::vector<bool>& done, std::vector<std::uint32_t>& row) const {
        const std::uint32_t first = facets_.flat_count();
        for (const std::uint32_t r : facets_.curved_neighbours_of(curved[region - first])) {
            if (!done[r - first] && !is_cylinder(r) &&
                align(r, curved[r - first], axis_of(facets_.region(region).surface))) {
                done[r - first] = true;
                row.push_back(r);
            }
        }
    }

    /// The line in which two facets meet: a straight line of the cone that they chord.
    [[nodiscard]] Eigen::Vector3d ridge(std::uint32_t f, std::uint32_t g) const {
        return facets_[f].normal.cross(facets_[g].normal).normalized();
    }

    /// The strip that follows `last` as `last` follows `before`: turned by about as much, about a
    /// line near to the one before.
    [[nodiscard]] std::optional<std::uint32_t> next_strip(std::uint32_t before, std::uint32_t last,
                                                          const Chain& chain) const {
        const double step = facets_.angle_between(before, last);
        const Eigen::Vector3d here = ridge(before, last);
        double best = std::cos(kWidestStep);
        std::optional<std::uint32_t> next;
        facets_.for_each_halfedge(last, [&](std::uint32_t h) {
            const std::uint32_t g = facets_.across(h);
            if (!facets_.is_flat(g) || !facets_.usable(g) ||
                std::find(chain.begin(), chain.end(), g) != chain.end()) {
                return;
            }
            const double angle = facets_.angle_between(last, g);
            const double straight = here.dot(ridge(last, g));
            if (angle > step / kUneven && angle < step * kUneven && straight > best) {
                best = straight;
                next = g;
            }
        });
        return next;
    }

    [[nodiscard]] Chain chain_from(std::uint32_t f, std::uint32_t g) const {
        Chain chain{f, g};
        bool longer = true;
        while (longer && chain.size() < kSeedStrips) {
            longer = false;
            if (const auto next = next_strip(chain[chain.size() - 2], chain.back(), chain)) {
                chain.push_back(*next);
                longer = true;
            }
            if (const auto next = next_strip(chain[1], chain[0], chain)) {
                chain.push_front(*next);
                longer = true;
            }
        }
        return chain;
    }

    /// A chain, the same without its ends, and three of it.
    static std::vector<std::vector<std::uint32_t>> parts_of(const Chain& chain, std::uint32_t f,
                                                            std::uint32_t g) {
        std::vector<std::vector<std::uint32_t>> parts;
        const auto add = [&](std::size_t from, std::size_t count) {
            if (count >= kFewestStrips && from + count <= chain.size()) {
                const auto begin = chain.begin() + static_cast<std::ptrdiff_t>(from);
                parts.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(count));
            }
        };
        const auto of_f = std::find(chain.begin(), chain.end(), f);
        const auto of_g = std::find(chain.begin(), chain.end(), g);
        const auto first = static_cast<std::size_t>(std::min(of_f, of_g) - chain.begin());
        add(0, chain.size());
        if (chain.size() > kFewestStrips) {
            add(1, chain.size() - 2);
            add(1, chain.size() - 1);
            add(0, chain.size() - 1);
            if (first > 0) {
                add(first - 1, kFewestStrips);
            }
            add(first, kFewestStrips);
        }
        return parts;
    }

    [[nodiscard]] std::vector<Eigen::Vector3d> points_of(
        const std::vector<std::uint32_t>& found) const {
        const std::vector<std::uint32_t> numbers = facets_.points_of(found);
        std::vector<Eigen::Vector3d> points;
        points.reserve(numbers.size());
        for (const std::uint32_t p : numbers) {
            points.push_back(facets_.point(p));
        }
        return points;
    }

    static bool is_cone(const ConeFit& cone) {
        return cone.half_angle > kSlimmest && cone.half_angle < kFlattest;
    }

    /// The cone through the points of a few strips.
    [[nodiscard]] std::optional<ConeFit> cone_of(const std::vector<std::uint32_t>& chain) const {
        std::vector<PlaneSurface> planes;
        planes.reserve(chain.size());
        for (const std::uint32_t f : chain) {
            planes.push_back(facets_.plane(f));
        }
        const std::vector<Eigen::Vector3d> points = points_of(chain);
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const Eigen::Vector3d& p : points) {
            middle += p / static_cast<double>(points.size());
        }
        const auto inside = cone_inside(planes, middle);
        if (!inside || !is_cone(*inside)) {
            return std::nullopt;
        }
        // Most strips chord no cone: that shows soon.
        constexpr int kFirstRounds = 2;
        const ConeFit rough = fit_cone(points, *inside, {}, kFirstRounds);
        if (!std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
                return std::abs(rough.distance_mm(p)) <= options_.tolerance_mm;
            })) {
            return std::nullopt;
        }
        const ConeFit cone = fit_cone(points, rough);
        return is_cone(cone) ? std::optional(cone) : std::nullopt;
    }

    /// The cone with its apex in the middle of a fan.
    [[nodiscard]] std::optional<ConeFit> cone_of(const Fan& fan) const {
        // Unit steps from the apex along the straight lines end on one circle.
        std::vector<Eigen::Vector3d> ends;
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const std::uint32_t p : facets_.points_of(fan.facets)) {
            if (p != fan.point) {
                ends.push_back((facets_.point(p) - facets_.point(fan.point)).normalized());
                middle += ends.back();
            }
        }
        middle /= static_cast<double>(ends.size());
        Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
        for (const Eigen::Vector3d& end : ends) {
            spread += (end - middle) * (end - middle).transpose();
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
        ConeFit cone;
        cone.centre = facets_.point(fan.point);
        cone.axis = solver.eigenvectors().col(0);
        cone.axis = cone.axis.dot(middle) < 0 ? Eigen::Vector3d(-cone.axis) : cone.axis;
        cone.half_angle = std::acos(std::clamp(cone.axis.dot(middle), -1.0, 1.0));
        return is_cone(cone) ? std::optional(cone) : std::nullopt;
    }

    /// The cone as it is seen along its straight lines, where its points reach highest.
    void look_along(const ConeFit& cone, const std::vector<Eigen::Vector3d>& points,
                    Guess& guess) const {
        const ConeSurface surface = cone.surface();
        double height = 0;
        for (const Eigen::Vector3d& p : points) {
            height = std::max(height, surface.axis.dot(p - surface.apex));
        }
        const double radius = height * std::tan(surface.half_angle);
        guess.widest_mm *= guess.circle.radius > 0 ? radius / guess.circle.radius : 1;
        guess.rulings = Rulings::through(surface, height, kAtApex * options_.planar_mm);
        guess.circle = {Eigen::Vector2d::Zero(), radius};
    }

    bool try_cone(const ConeFit& cone, const std::vector<std::uint32_t>& chain) {
        Guess guess{Rulings::parallel(cone.axis), {}};
        look_along(cone, points_of(chain), guess);
        for (const std::uint32_t f : chain) {
            const auto sides = strips_.sides_of(f, guess.rulings);
            if (!sides) {
                return false;
            }
            const double width = (sides->first - sides->second).norm();
            guess.widest_mm = std::max(guess.widest_mm, 1.5 * width);
        }
        if (guess.widest_mm > 3 * guess.circle.radius) {
            return false;
        }
        guess.outward = guess.rulings.across(facets_[chain[0]].normal)
                            .dot(strips_.sides_of(chain[0], guess.rulings)->first) > 0;
        const double half = guess.widest_mm / 3 / guess.circle.radius;
        guess.reach_mm = strips_.reach_mm(guess.circle.radius * (1 - std::sqrt(1 - half * half)) /
                                          guess.rulings.magnified());
        guess.within_mm = guess.reach_mm;
        ConeFit fitted = cone;
        const auto found = strips_.settle(
            guess, chain[chain.size() / 2],
            [&](const auto& facets, Guess& better) { return refit(facets, better, fitted); });
        if (!found || !is_cone(fitted) || !tapers(*found, fitted)) {
            return false;
        }
        facets_.keep(found->facets, fitted.surface(), found->guess.outward, found->sagitta_mm);
        return true;
    }

    /// A cone has two radii that differ.
    [[nodiscard]] bool tapers(const Chorded& found, const ConeFit& cone) const {
        double low = INFINITY;
        double high = -low;
        for (const Eigen::Vector3d& p : points_of(found.facets)) {
            low = std::min(low, cone.axis.dot(p));
            high = std::max(high, cone.axis.dot(p));
        }
        return (high - low) * std::sin(cone.half_angle) > kTaper * options_.planar_mm;
    }

    /// The axis of a curved neighbour that is the cone's as well.
    [[nodiscard]] std::optional<AxisLine> shared_axis(const std::vector<std::uint32_t>& found,
                                                      const ConeFit& cone, double near_mm) const {
        for (const std::uint32_t r : facets_.curved_neighbours_of(found)) {
            const AxisLine line = axis_of(facets_.region(r).surface);
            const double apart = (cone.centre - line.origin).cross(line.axis).norm();
            if (line.axis.cross(cone.axis).norm() < kAlmost && apart <= near_mm) {
                return line;
            }
        }
        return std::nullopt;
    }

    /// What lies around the cone and almost fits it, has to fit exactly: otherwise they would meet
    /// in curves that are neither lines nor circles.
    /// @param all or only what lies square to the axis or along it
    [[nodiscard]] ConeLimits limits_of(const std::vector<std::uint32_t>& found, const Guess& guess,
                                       bool all, ConeFit& cone) const {
        const double near_mm =
            std::max(10 * options_.planar_mm,
                     std::min(options_.tolerance_mm, 0.1 * strips_.sagitta_of(found, guess)));
        ConeLimits limits;
        limits.side = guess.outward ? 1 : -1;
        const std::vector<std::uint32_t> around = facets_.neighbours_of(found);
        if (const auto line = all ? shared_axis(found, cone, near_mm) : std::nullopt) {
            const double sense = line->axis.dot(cone.axis) < 0 ? -1 : 1;
            cone.axis = sense * line->axis;
            cone.centre = line->origin + cone.axis * cone.axis.dot(cone.centre - line->origin);
            limits.fixed_direction = limits.fixed_centre = true;
        } else {
            const auto cap = std::find_if(around.begin(), around.end(), [&](std::uint32_t g) {
                return facets_.plane(g).normal.cross(cone.axis).norm() < kAlmost;
            });
            if (cap != around.end()) {
                const Eigen::Vector3d& normal = facets_.plane(*cap).normal;
                cone.axis = normal.dot(cone.axis) < 0 ? Eigen::Vector3d(-normal) : normal;
                limits.fixed_direction = true;
            }
        }
        add_planes(around, cone, near_mm, limits);
        if (!all) {
            limits.touched.clear();
        }
        return limits;
    }

    /// Planes that almost contain the axis, or almost touch the cone.
    void add_planes(const std::vector<std::uint32_t>& around, const ConeFit& cone, double near_mm,
                    ConeLimits& limits) const {
        for (const std::uint32_t g : around) {
            const PlaneSurface& plane = facets_.plane(g);
            const double along = plane.normal.dot(cone.axis);
            const double off = plane.normal.dot(cone.centre) - plane.offset_mm;
            if (std::abs(along) < kAlmost && std::abs(off) <= near_mm) {
                limits.along.push_back(plane);
            } else if (std::abs(along + limits.side * std::sin(cone.half_angle)) < kAlmost &&
                       std::abs(off + limits.side * cone.offset_mm) <= near_mm) {
                limits.touched.push_back(plane);
            }
        }
    }

    /// Lays a cone on the axis of a neighbour. False where it has another, or keeps to planes.
    [[nodiscard]] bool align(std::uint32_t r, const std::vector<std::uint32_t>& own,
                             const AxisLine& line) const {
        const Region& region = facets_.region(r);
        const auto& before = std::get<ConeSurface>(region.surface);
        const std::vector<Eigen::Vector3d> points = points_of(own);
        ConeFit cone{points[0], before.axis, before.half_angle, 0};
        cone.centre = before.apex + before.axis * before.axis.dot(points[0] - before.apex);
        cone.offset_mm = std::sin(before.half_angle) * (cone.centre - before.apex).norm();
        const double near_mm = std::max(10 * options_.planar_mm,
                                        std::min(options_.tolerance_mm, 0.1 * region.sagitta_mm));
        ConeLimits limits;
        limits.fixed_direction = limits.fixed_centre = true;
        limits.side = region.outward ? 1 : -1;
        add_planes(facets_.flat_around(own), cone, near_mm, limits);
        if (!limits.along.empty() || !limits.touched.empty() ||
            line.axis.cross(cone.axis).norm() > kAlmost ||
            (cone.centre - line.origin).cross(line.axis).norm() > near_mm) {
            return false;
        }
        cone.axis = line.axis * (line.axis.dot(cone.axis) < 0 ? -1 : 1);
        cone.centre = line.origin + cone.axis * cone.axis.dot(cone.centre - line.origin);
        const double median = fit_near(points, limits, cone);
        if (!(median <= strips_.rest_mm(region.sagitta_mm)) || !is_cone(cone)) {
            return false;
        }
        facets_.lay(r, cone.surface());
        return true;
    }

    /// Fits, keeps what is near, and fits again. The median distance.
    double fit_near(const std::vector<Eigen::Vector3d>& points, const ConeLimits& limits,
                    ConeFit& cone) const {
        double median = 0;
        for (int round = 0; round < 4; ++round) {
            std::vector<double> off;
            off.reserve(points.size());
            for (const Eigen::Vector3d& p : points) {
                off.push_back(std::abs(cone.distance_mm(p)));
            }
            const Nearest nearest = nearest_of(off, options_.planar_mm);
            std::vector<Eigen::Vector3d> near;
            near.reserve(nearest.near.size());
            for (const std::size_t i : nearest.near) {
                near.push_back(points[i]);
            }
            cone = fit_cone(near, cone, limits);
            median = nearest.median;
        }
        return median;
    }

    double refit(const std::vector<std::uint32_t>& found, Guess& guess, ConeFit& cone) const {
        const std::vector<Eigen::Vector3d> points = points_of(found);
        const ConeFit before = cone;
        double median = fit_near(points, limits_of(found, guess, true, cone), cone);
        if (!(median <= strips_.rest_mm(strips_.sagitta_of(found, guess)))) {
            // Neighbours that are known no better than these points mislead.
            cone = before;
            median = fit_near(points, limits_of(found, guess, false, cone), cone);
        }
        if (!is_cone(cone)) {
            return INFINITY;
        }
        look_along(cone, points, guess);
        return median;
    }

    Facets& facets_;
    const RegionOptions& options_;
    Strips strips_;
};

}  // namespace

void find_cones(Facets& facets, const RegionOptions& options) {
    ConeFinder(facets, options).find();
}

void align_cones(Facets& facets, const RegionOptions& options) {
    ConeFinder(facets, options).align_all();
}

void find_curved(const part::Part& part, const Adjacency& adjacency, const RegionOptions& options,
                 Regions& regions) {
    Facets facets(part, adjacency, regions);
    // Cones first: pieces of a turned shape look like cylinders the other way.
    find_cones(facets, options);
    find_cylinders(facets, options);
    align_cones(facets, options);
    regions.band_of = regions.of;
    find_tori(facets, options);
}

}  // namespace decomp::solid
