// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/cone_fit.h"
#include "decomp/solid/strips.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <deque>

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

/// A straight line.
struct Axis {
    Eigen::Vector3d point;
    Eigen::Vector3d direction;
};

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
            if (chain.size() >= kFewestStrips) {
                if (const auto cone = cone_of(chain)) {
                    try_cone(*cone, {chain.begin(), chain.end()});
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

  private:
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
    [[nodiscard]] std::optional<ConeFit> cone_of(const Chain& chain) const {
        std::vector<PlaneSurface> planes;
        planes.reserve(chain.size());
        for (const std::uint32_t f : chain) {
            planes.push_back(facets_.plane(f));
        }
        const std::vector<Eigen::Vector3d> points = points_of({chain.begin(), chain.end()});
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const Eigen::Vector3d& p : points) {
            middle += p / static_cast<double>(points.size());
        }
        const auto inside = cone_inside(planes, middle);
        if (!inside || !is_cone(*inside)) {
            return std::nullopt;
        }
        const ConeFit cone = fit_cone(points, *inside);
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

    void try_cone(const ConeFit& cone, const std::vector<std::uint32_t>& chain) {
        Guess guess{Rulings::parallel(cone.axis), {}};
        look_along(cone, points_of(chain), guess);
        for (const std::uint32_t f : chain) {
            const auto sides = strips_.sides_of(f, guess.rulings);
            if (!sides) {
                return;
            }
            const double width = (sides->first - sides->second).norm();
            guess.widest_mm = std::max(guess.widest_mm, 1.5 * width);
        }
        if (guess.widest_mm > 3 * guess.circle.radius) {
            return;
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
        if (found && is_cone(fitted) && tapers(*found, fitted)) {
            facets_.keep(found->facets, fitted.surface(), found->guess.outward, found->sagitta_mm);
        }
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
    [[nodiscard]] std::optional<Axis> shared_axis(const std::vector<std::uint32_t>& found,
                                                  const ConeFit& cone, double near_mm) const {
        for (const std::uint32_t r : facets_.curved_neighbours_of(found)) {
            const Surface& surface = facets_.region(r).surface;
            const auto* other = std::get_if<ConeSurface>(&surface);
            const auto* cylinder = std::get_if<CylinderSurface>(&surface);
            const Axis axis = other != nullptr ? Axis{other->apex, other->axis}
                                               : Axis{cylinder->origin, cylinder->axis};
            const double apart = (cone.centre - axis.point).cross(axis.direction).norm();
            if (axis.direction.cross(cone.axis).norm() < kAlmost && apart <= near_mm) {
                return axis;
            }
        }
        return std::nullopt;
    }

    /// What lies around the cone and almost fits it, has to fit exactly: otherwise they would meet
    /// in curves that are neither lines nor circles.
    [[nodiscard]] ConeLimits limits_of(const std::vector<std::uint32_t>& found, const Guess& guess,
                                       ConeFit& cone) const {
        const double near_mm =
            std::max(10 * options_.planar_mm,
                     std::min(options_.tolerance_mm, 0.1 * strips_.sagitta_of(found, guess)));
        ConeLimits limits;
        limits.side = guess.outward ? 1 : -1;
        const std::vector<std::uint32_t> around = facets_.neighbours_of(found);
        if (const auto axis = shared_axis(found, cone, near_mm)) {
            const double sense = axis->direction.dot(cone.axis) < 0 ? -1 : 1;
            cone.axis = sense * axis->direction;
            cone.centre = axis->point + cone.axis * cone.axis.dot(cone.centre - axis->point);
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
        return limits;
    }

    /// Fits, keeps what is near, and fits again.
    double refit(const std::vector<std::uint32_t>& found, Guess& guess, ConeFit& cone) const {
        const std::vector<Eigen::Vector3d> points = points_of(found);
        const ConeLimits limits = limits_of(found, guess, cone);
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

void find_curved(const part::Part& part, const Adjacency& adjacency, const RegionOptions& options,
                 Regions& regions) {
    Facets facets(part, adjacency, regions);
    find_cylinders(facets, options);
    find_cones(facets, options);
}

}  // namespace decomp::solid
