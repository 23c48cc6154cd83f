// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/circle_fit.h"
#include "decomp/solid/strips.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>

namespace decomp::solid {

namespace {

class CylinderFinder {
  public:
    CylinderFinder(Facets& facets, const RegionOptions& options)
        : facets_(facets), options_(options), strips_(facets, options) {}

    void find() {
        for (const auto& [f, g] : facets_.pairs(kNarrowestStep, kWidestStep)) {
            if (!facets_.usable(f) || !facets_.usable(g)) {
                continue;
            }
            const auto guess = guess_from(f, g);
            const auto found = guess ? strips_.settle(*guess, f,
                                                      [&](const auto& facets, Guess& better) {
                                                          return refit(facets, better);
                                                      })
                                     : std::nullopt;
            if (found) {
                facets_.keep(found->facets, surface_of(*found), found->guess.outward,
                             found->sagitta_mm);
            }
        }
    }

  private:
    [[nodiscard]] std::optional<Guess> guess_from(std::uint32_t f, std::uint32_t g) const {
        const Rulings rulings =
            Rulings::parallel(facets_[f].normal.cross(facets_[g].normal).normalized());
        const auto of_f = strips_.sides_of(f, rulings);
        const auto of_g = strips_.sides_of(g, rulings);
        if (!of_f || !of_g) {
            return std::nullopt;
        }
        // The side in common is where the strips come nearest.
        std::array<Eigen::Vector2d, 2> a{of_f->first, of_f->second};
        std::array<Eigen::Vector2d, 2> b{of_g->first, of_g->second};
        double nearest = INFINITY;
        std::size_t common_a = 0;
        std::size_t common_b = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t j = 0; j < 2; ++j) {
                if ((a.at(i) - b.at(j)).norm() < nearest) {
                    nearest = (a.at(i) - b.at(j)).norm();
                    common_a = i;
                    common_b = j;
                }
            }
        }
        const auto circle = circle_through(a.at(1 - common_a), a.at(common_a), b.at(1 - common_b));
        if (!circle || nearest > options_.tolerance_mm) {
            return std::nullopt;
        }
        const double width_a = (a[0] - a[1]).norm();
        const double width_b = (b[0] - b[1]).norm();
        if (width_a > kUneven * width_b || width_b > kUneven * width_a) {
            return std::nullopt;
        }
        const double half = std::max(width_a, width_b) / (2 * circle->radius);
        // Three points of float coordinates guess a circle; what lies far from it against its
        // sagitta is no chord of it.
        const double reach_mm = strips_.reach_mm(circle->radius * (1 - std::sqrt(1 - half * half)));
        const bool outward =
            rulings.across(facets_[f].normal).dot((a[0] + a[1]) / 2 - circle->centre) > 0;
        return Guess{rulings,  *circle,  outward,
                     reach_mm, reach_mm, 1.5 * std::max(width_a, width_b)};
    }

    /// The direction that the facets' normals avoid, laid along or square to the large planes
    /// around them where it almost is.
    [[nodiscard]] Eigen::Vector3d axis_of(const std::vector<std::uint32_t>& found,
                                          const Eigen::Vector3d& before) const {
        Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
        for (const std::uint32_t f : found) {
            spread += facets_[f].area_mm2 * facets_[f].normal * facets_[f].normal.transpose();
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
        Eigen::Vector3d axis = solver.eigenvectors().col(0);
        axis = axis.dot(before) < 0 ? Eigen::Vector3d(-axis) : axis;
        const std::vector<std::uint32_t> around = facets_.neighbours_of(found);
        const auto cap = std::find_if(around.begin(), around.end(), [&](std::uint32_t g) {
            return 1 - std::abs(facets_[g].normal.dot(axis)) < kAlmost * kAlmost;
        });
        if (cap != around.end()) {
            return along(facets_.plane(*cap).normal, axis);
        }
        const std::vector<std::uint32_t> flanks = flanks_of(found, axis);
        if (flanks.empty()) {
            return axis;
        }
        const Eigen::Vector3d first = facets_.plane(flanks[0]).normal;
        for (const std::uint32_t g : flanks) {
            const Eigen::Vector3d both = first.cross(facets_.plane(g).normal);
            if (both.norm() > 0.5) {
                return along(both.normalized(), axis);
            }
        }
        return (axis - first * first.dot(axis)).normalized();
    }

    static Eigen::Vector3d along(const Eigen::Vector3d& direction, const Eigen::Vector3d& axis) {
        return direction.dot(axis) < 0 ? Eigen::Vector3d(-direction) : direction;
    }

    /// Flat neighbours across an edge that runs along the axis, largest first.
    [[nodiscard]] std::vector<std::uint32_t> flanks_of(const std::vector<std::uint32_t>& found,
                                                       const Eigen::Vector3d& axis) const {
        std::vector<std::uint32_t> flanks;
        for (const std::uint32_t f : found) {
            facets_.for_each_halfedge(f, [&](std::uint32_t h) {
                const std::uint32_t g = facets_.across(h);
                const Eigen::Vector3d way = facets_.way(h);
                if (facets_.is_flat_outside(g) && way.cross(axis).norm() < kAlmost * way.norm() &&
                    std::abs(facets_[g].normal.dot(axis)) < kAlmost) {
                    flanks.push_back(g);
                }
            });
        }
        return facets_.by_area(std::move(flanks));
    }

    /// The largest flat neighbours that the cylinder touches within the noise of the points: it is
    /// made to touch them exactly, so that they meet in a line.
    [[nodiscard]] std::vector<TangentLine> tangents_of(const std::vector<std::uint32_t>& found,
                                                       const Guess& guess) const {
        std::vector<TangentLine> touched;
        for (const std::uint32_t g : flanks_of(found, guess.rulings.axis())) {
            const PlaneSurface& plane = facets_.plane(g);
            if (touched.size() == 2) {
                break;
            }
            const TangentLine line{guess.rulings.across(plane.normal), guess.outward ? 1.0 : -1.0,
                                   plane.offset_mm};
            const double gap = line.normal.dot(guess.circle.centre) +
                               line.side * guess.circle.radius - line.offset;
            // By the sagitta: the first guess of a circle stands on three noisy points.
            const double near =
                std::max(10 * options_.planar_mm,
                         std::min(options_.tolerance_mm, 0.1 * strips_.sagitta_of(found, guess)));
            const bool other = touched.empty() || (touched[0].normal - line.normal).norm() > 0.1;
            if (std::abs(gap) <= near && other) {
                touched.push_back(line);
            }
        }
        return touched;
    }

    /// Fits, keeps what is near, and fits again.
    [[nodiscard]] double refit(const std::vector<std::uint32_t>& found, Guess& guess) const {
        const Eigen::Vector3d centre = guess.rulings.in_space(guess.circle.centre);
        guess.rulings = Rulings::parallel(axis_of(found, guess.rulings.axis()));
        guess.circle.centre = guess.rulings(centre);
        const std::vector<std::uint32_t> numbers = facets_.points_of(found);
        std::vector<Eigen::Vector2d> points;
        points.reserve(numbers.size());
        for (const std::uint32_t p : numbers) {
            points.push_back(guess.rulings(facets_.point(p)));
        }
        const std::vector<TangentLine> touched = tangents_of(found, guess);
        double median = 0;
        for (int round = 0; round < 4; ++round) {
            std::vector<double> off;
            off.reserve(points.size());
            for (const Eigen::Vector2d& q : points) {
                off.push_back(std::abs((q - guess.circle.centre).norm() - guess.circle.radius));
            }
            const Nearest nearest = nearest_of(off, options_.planar_mm);
            std::vector<Eigen::Vector2d> near;
            near.reserve(nearest.near.size());
            for (const std::size_t i : nearest.near) {
                near.push_back(points[i]);
            }
            guess.circle = fit_circle(near, guess.circle, touched);
            median = nearest.median;
        }
        return median;
    }

    [[nodiscard]] CylinderSurface surface_of(const Chorded& found) const {
        const Eigen::Vector3d& axis = found.guess.rulings.axis();
        double lowest = INFINITY;
        for (const std::uint32_t p : facets_.points_of(found.facets)) {
            lowest = std::min(lowest, axis.dot(facets_.point(p)));
        }
        return {found.guess.rulings.in_space(found.guess.circle.centre) + lowest * axis, axis,
                found.guess.circle.radius};
    }

    Facets& facets_;
    const RegionOptions& options_;
    Strips strips_;
};

}  // namespace

void find_cylinders(Facets& facets, const RegionOptions& options) {
    CylinderFinder(facets, options).find();
}

}  // namespace decomp::solid
