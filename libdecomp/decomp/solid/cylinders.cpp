// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/measure.h"
#include "decomp/solid/circle_fit.h"
#include "decomp/solid/regions.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace decomp::solid {

namespace {

constexpr double kWidestStep =
    31 * std::numbers::pi / 180;  ///< of a circle of 12 chords, and a bit
constexpr double kNarrowestStep = 0.2 * std::numbers::pi / 180;  ///< below it, a plane
constexpr double kUneven = 3;  ///< between the widths of neighbouring strips
constexpr int kFewestStrips = 3;
constexpr double kRestOfSagitta =
    0.002;                             ///< points deviate by no more than this share of the sagitta
constexpr double kSideOfWidth = 1e-3;  ///< points within it belong to one side of a strip
constexpr double kSeedOfSagitta = 0.05;
constexpr double kFloatNoise = 0.3;  ///< of planar_mm: what rounding to float leaves
constexpr int kRounds = 8;
constexpr double kAlmost = 1e-3;  ///< radians between directions that are meant to be one

/// A flat region, or a triangle alone.
struct Facet {
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> points;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double area_mm2 = 0;
    bool cut = false;
};

/// The plane square to an axis, with coordinates.
struct Across {
    explicit Across(const Eigen::Vector3d& direction)
        : axis(direction), u(reference_direction(direction)), v(axis.cross(u)) {}

    [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector3d& p) const {
        return {u.dot(p), v.dot(p)};
    }

    Eigen::Vector3d axis;
    Eigen::Vector3d u;
    Eigen::Vector3d v;
};

/// What a cylinder is while its facets are gathered.
struct Guess {
    Eigen::Vector3d axis;
    CircleFit circle;  ///< in Across(axis)
    bool outward = true;
    double within_mm = 0;
    double reach_mm = 0;   ///< the most that within_mm may become
    double widest_mm = 0;  ///< chord of a strip: a plane that touches the cylinder is none of it
};

class CylinderFinder {
  public:
    CylinderFinder(const part::Part& part, const Adjacency& adjacency, const RegionOptions& options,
                   Regions& regions)
        : mesh_(part.mesh),
          part_(part),
          adjacency_(adjacency),
          options_(options),
          regions_(regions) {
        make_facets();
    }

    void find() {
        for (const auto& [f, g] : seeds()) {
            if (taken_[f] || taken_[g]) {
                continue;
            }
            if (auto guess = guess_from(f, g)) {
                settle(*guess, f);
            }
        }
    }

  private:
    void make_facets() {
        facet_of_.resize(mesh_.triangles.size());
        flat_count_ = static_cast<std::uint32_t>(regions_.all.size());
        facets_.resize(flat_count_);
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            const std::int32_t region = regions_.of[t];
            if (region < 0) {
                facet_of_[t] = static_cast<std::uint32_t>(facets_.size());
                facets_.emplace_back();
            } else {
                facet_of_[t] = static_cast<std::uint32_t>(region);
            }
            Facet& facet = facets_[facet_of_[t]];
            facet.triangles.push_back(t);
            facet.normal += mesh::double_area_normal(mesh_, t);
            facet.cut = !part_.sources.empty() && part_.sources[t].is_cut();
            facet.points.insert(facet.points.end(), mesh_.triangles[t].begin(),
                                mesh_.triangles[t].end());
        }
        for (Facet& facet : facets_) {
            facet.area_mm2 = facet.normal.norm() / 2;
            facet.normal.normalize();
            std::sort(facet.points.begin(), facet.points.end());
            facet.points.erase(std::unique(facet.points.begin(), facet.points.end()),
                               facet.points.end());
        }
        taken_.assign(facets_.size(), false);
        mark_.assign(facets_.size(), 0);
    }

    [[nodiscard]] bool usable(std::uint32_t f) const {
        return !facets_[f].cut && !taken_[f] && facets_[f].area_mm2 > 0;
    }

    /// Pairs of neighbouring flat regions at a small angle, largest first.
    [[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> seeds() const {
        std::map<std::pair<std::uint32_t, std::uint32_t>, double> pairs;
        for (std::uint32_t h = 0; h < adjacency_.twin.size(); ++h) {
            const std::uint32_t f = facet_of_[h / 3];
            const std::uint32_t g = facet_of_[adjacency_.twin[h] / 3];
            if (f >= g || g >= flat_count_ || !usable(f) || !usable(g)) {
                continue;
            }
            const double angle = angle_between(f, g);
            if (angle > kNarrowestStep && angle < kWidestStep) {
                pairs[{f, g}] = std::min(facets_[f].area_mm2, facets_[g].area_mm2);
            }
        }
        std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
        order.reserve(pairs.size());
        for (const auto& [pair, area] : pairs) {
            order.push_back(pair);
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](const auto& a, const auto& b) { return pairs[a] > pairs[b]; });
        return order;
    }

    [[nodiscard]] double angle_between(std::uint32_t f, std::uint32_t g) const {
        return std::atan2(facets_[f].normal.cross(facets_[g].normal).norm(),
                          facets_[f].normal.dot(facets_[g].normal));
    }

    /// The two sides of a strip along the axis, as points across it; nothing where a side is no
    /// line but a corner.
    [[nodiscard]] std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> sides_of(
        std::uint32_t f, const Across& across) const {
        const Facet& facet = facets_[f];
        const Eigen::Vector3d along = facet.normal.cross(across.axis).normalized();
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (const std::uint32_t p : facet.points) {
            low = std::min(low, along.dot(mesh_.points[p]));
            high = std::max(high, along.dot(mesh_.points[p]));
        }
        const double near = std::max(10 * options_.planar_mm, kSideOfWidth * (high - low));
        std::pair<Eigen::Vector2d, Eigen::Vector2d> sides{Eigen::Vector2d::Zero(),
                                                          Eigen::Vector2d::Zero()};
        int at_low = 0;
        int at_high = 0;
        for (const std::uint32_t p : facet.points) {
            const double s = along.dot(mesh_.points[p]);
            if (s <= low + near) {
                sides.first += across(mesh_.points[p]);
                ++at_low;
            } else if (s >= high - near) {
                sides.second += across(mesh_.points[p]);
                ++at_high;
            }
        }
        if (at_low < 2 || at_high < 2) {
            return std::nullopt;
        }
        sides.first /= at_low;
        sides.second /= at_high;
        return sides;
    }

    [[nodiscard]] std::optional<Guess> guess_from(std::uint32_t f, std::uint32_t g) const {
        Guess guess;
        guess.axis = facets_[f].normal.cross(facets_[g].normal).normalized();
        const Across across(guess.axis);
        const auto of_f = sides_of(f, across);
        const auto of_g = sides_of(g, across);
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
        guess.widest_mm = 1.5 * std::max(width_a, width_b);
        guess.circle = *circle;
        guess.outward = across(facets_[f].normal).dot((a[0] + a[1]) / 2 - circle->centre) > 0;
        // Three points of float coordinates guess a circle; what lies far from it against its
        // sagitta is no chord of it.
        const double half = std::max(width_a, width_b) / (2 * circle->radius);
        guess.reach_mm =
            std::min(options_.tolerance_mm,
                     std::max(20 * options_.planar_mm,
                              kSeedOfSagitta * circle->radius * (1 - std::sqrt(1 - half * half))));
        guess.within_mm = guess.reach_mm;
        return guess;
    }

    /// A facet chords the cylinder: its extreme points lie on it, the others on the chord between
    /// them.
    [[nodiscard]] bool chords(std::uint32_t f, const Guess& guess, const Across& across) const {
        const Facet& facet = facets_[f];
        if (std::abs(facet.normal.dot(guess.axis)) > 0.1) {
            return false;
        }
        const Eigen::Vector3d along = facet.normal.cross(guess.axis).normalized();
        std::uint32_t low = facet.points[0];
        std::uint32_t high = facet.points[0];
        for (const std::uint32_t p : facet.points) {
            low = along.dot(mesh_.points[p]) < along.dot(mesh_.points[low]) ? p : low;
            high = along.dot(mesh_.points[p]) > along.dot(mesh_.points[high]) ? p : high;
        }
        const Eigen::Vector2d from = across(mesh_.points[low]);
        const Eigen::Vector2d to = across(mesh_.points[high]);
        const auto off_circle = [&](const Eigen::Vector2d& p) {
            return std::abs((p - guess.circle.centre).norm() - guess.circle.radius);
        };
        const Eigen::Vector2d chord = to - from;
        const Eigen::Vector2d middle = (from + to) / 2 - guess.circle.centre;
        if (off_circle(from) > guess.within_mm || off_circle(to) > guess.within_mm ||
            chord.norm() > guess.widest_mm ||
            chord.norm() > 2 * guess.circle.radius * std::sin(kWidestStep / 2) ||
            (across(facet.normal).dot(middle) > 0) != guess.outward) {
            return false;
        }
        const Eigen::Vector2d side = Eigen::Vector2d(-chord.y(), chord.x()).normalized();
        return std::all_of(facet.points.begin(), facet.points.end(), [&](std::uint32_t p) {
            const Eigen::Vector2d q = across(mesh_.points[p]);
            return std::abs(side.dot(q - from)) <= guess.within_mm ||
                   off_circle(q) <= guess.within_mm;
        });
    }

    /// Calls visit for every halfedge of the triangles of a facet.
    template <class Visit>
    void for_each_halfedge(std::uint32_t f, const Visit& visit) const {
        for (const std::uint32_t t : facets_[f].triangles) {
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                visit(h);
            }
        }
    }

    /// The facet on the other side of a halfedge.
    [[nodiscard]] std::uint32_t facet_across(std::uint32_t h) const {
        return facet_of_[adjacency_.twin[h] / 3];
    }

    [[nodiscard]] std::vector<std::uint32_t> gather(const Guess& guess, std::uint32_t seed) {
        const Across across(guess.axis);
        std::vector<std::uint32_t> found;
        if (!chords(seed, guess, across)) {
            return found;
        }
        ++stamp_;
        found.push_back(seed);
        mark_[seed] = stamp_;
        for (std::size_t i = 0; i < found.size(); ++i) {
            for_each_halfedge(found[i], [&](std::uint32_t h) {
                const std::uint32_t g = facet_across(h);
                if (mark_[g] != stamp_ && usable(g) && chords(g, guess, across)) {
                    mark_[g] = stamp_;
                    found.push_back(g);
                }
            });
        }
        return found;
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
        const std::vector<std::uint32_t> around = neighbours_of(found);
        const auto cap = std::find_if(around.begin(), around.end(), [&](std::uint32_t g) {
            return 1 - std::abs(facets_[g].normal.dot(axis)) < kAlmost * kAlmost;
        });
        if (cap != around.end()) {
            return along(plane_normal(*cap), axis);
        }
        const std::vector<std::uint32_t> flanks = flanks_of(found, axis);
        if (flanks.empty()) {
            return axis;
        }
        const Eigen::Vector3d first = plane_normal(flanks[0]);
        for (const std::uint32_t g : flanks) {
            const Eigen::Vector3d both = first.cross(plane_normal(g));
            if (both.norm() > 0.5) {
                return along(both.normalized(), axis);
            }
        }
        return (axis - first * first.dot(axis)).normalized();
    }

    static Eigen::Vector3d along(const Eigen::Vector3d& direction, const Eigen::Vector3d& axis) {
        return direction.dot(axis) < 0 ? Eigen::Vector3d(-direction) : direction;
    }

    /// A flat region that is neither among the facets gathered nor part of a cylinder.
    [[nodiscard]] bool is_flat_outside(std::uint32_t g) const {
        return g < flat_count_ && mark_[g] != stamp_ && !taken_[g];
    }

    /// Flat neighbours across an edge that runs along the axis, largest first.
    [[nodiscard]] std::vector<std::uint32_t> flanks_of(const std::vector<std::uint32_t>& found,
                                                       const Eigen::Vector3d& axis) const {
        std::vector<std::uint32_t> flanks;
        for (const std::uint32_t f : found) {
            for_each_halfedge(f, [&](std::uint32_t h) {
                const std::uint32_t g = facet_across(h);
                const Eigen::Vector3d way =
                    mesh_.points[end_of(mesh_, h)] - mesh_.points[start_of(mesh_, h)];
                if (is_flat_outside(g) && way.cross(axis).norm() < kAlmost * way.norm() &&
                    std::abs(facets_[g].normal.dot(axis)) < kAlmost) {
                    flanks.push_back(g);
                }
            });
        }
        return by_area(std::move(flanks));
    }

    [[nodiscard]] std::vector<std::uint32_t> by_area(std::vector<std::uint32_t> regions) const {
        std::sort(regions.begin(), regions.end());
        regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
        std::stable_sort(regions.begin(), regions.end(), [&](std::uint32_t a, std::uint32_t b) {
            return facets_[a].area_mm2 > facets_[b].area_mm2;
        });
        return regions;
    }

    /// The largest flat neighbours that the cylinder touches within the noise of the points: it is
    /// made to touch them exactly, so that they meet in a line.
    [[nodiscard]] std::vector<TangentLine> tangents_of(const std::vector<std::uint32_t>& found,
                                                       const Guess& guess,
                                                       const Across& across) const {
        std::vector<TangentLine> touched;
        for (const std::uint32_t g : flanks_of(found, guess.axis)) {
            const auto& plane = std::get<PlaneSurface>(regions_.all[g].surface);
            if (touched.size() == 2) {
                break;
            }
            const TangentLine line{across(plane.normal), guess.outward ? 1.0 : -1.0,
                                   plane.offset_mm};
            const double gap = line.normal.dot(guess.circle.centre) +
                               line.side * guess.circle.radius - line.offset;
            // By the sagitta: the first guess of a circle stands on three noisy points.
            const double near =
                std::max(10 * options_.planar_mm,
                         std::min(options_.tolerance_mm, 0.1 * sagitta_of(found, guess)));
            const bool other = touched.empty() || (touched[0].normal - line.normal).norm() > 0.1;
            if (std::abs(gap) <= near && other) {
                touched.push_back(line);
            }
        }
        return touched;
    }

    [[nodiscard]] Eigen::Vector3d plane_normal(std::uint32_t f) const {
        return std::get<PlaneSurface>(regions_.all[f].surface).normal;
    }

    /// Flat regions that touch these facets and are none of them, largest first.
    [[nodiscard]] std::vector<std::uint32_t> neighbours_of(
        const std::vector<std::uint32_t>& found) const {
        std::vector<std::uint32_t> around;
        for (const std::uint32_t f : found) {
            for_each_halfedge(f, [&](std::uint32_t h) {
                if (const std::uint32_t g = facet_across(h); is_flat_outside(g)) {
                    around.push_back(g);
                }
            });
        }
        return by_area(std::move(around));
    }

    [[nodiscard]] std::vector<std::uint32_t> points_of(
        const std::vector<std::uint32_t>& found) const {
        std::vector<std::uint32_t> points;
        for (const std::uint32_t f : found) {
            points.insert(points.end(), facets_[f].points.begin(), facets_[f].points.end());
        }
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
        return points;
    }

    /// Fits, keeps what is near, and fits again: points which a cut has made lie on chords and drop
    /// out, those of the original surface remain.
    [[nodiscard]] double refit(const std::vector<std::uint32_t>& found, Guess& guess) const {
        const Across before(guess.axis);
        const Eigen::Vector3d centre =
            before.u * guess.circle.centre.x() + before.v * guess.circle.centre.y();
        guess.axis = axis_of(found, guess.axis);
        const Across across(guess.axis);
        guess.circle.centre = across(centre);
        std::vector<Eigen::Vector2d> points;
        for (const std::uint32_t p : points_of(found)) {
            points.push_back(across(mesh_.points[p]));
        }
        const std::vector<TangentLine> touched = tangents_of(found, guess, across);
        std::vector<double> off(points.size());
        double median = 0;
        for (int round = 0; round < 4; ++round) {
            for (std::size_t i = 0; i < points.size(); ++i) {
                off[i] = std::abs((points[i] - guess.circle.centre).norm() - guess.circle.radius);
            }
            std::vector<double> sorted = off;
            const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
            std::nth_element(sorted.begin(), middle, sorted.end());
            median = *middle;
            std::vector<Eigen::Vector2d> near;
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (off[i] <= 3 * median + options_.planar_mm) {
                    near.push_back(points[i]);
                }
            }
            guess.circle = fit_circle(near, guess.circle, touched);
        }
        return median;
    }

    void settle(Guess guess, std::uint32_t seed) {
        std::vector<std::uint32_t> found = gather(guess, seed);
        double median = 0;
        for (int round = 0; round < kRounds; ++round) {
            if (found.size() < kFewestStrips) {
                return;
            }
            median = refit(found, guess);
            guess.within_mm =
                std::min(guess.reach_mm, std::max(5 * median, 3 * options_.planar_mm));
            std::vector<std::uint32_t> again = gather(guess, seed);
            const bool same = again == found;
            found = std::move(again);
            if (same && round > 0) {
                break;
            }
        }
        if (found.size() < kFewestStrips) {
            return;
        }
        const double sagitta_mm = sagitta_of(found, guess);
        if (median > std::max(kFloatNoise * options_.planar_mm, kRestOfSagitta * sagitta_mm) ||
            strips_among(found, guess) < kFewestStrips) {
            return;
        }
        keep(found, guess, sagitta_mm);
    }

    [[nodiscard]] double sagitta_of(const std::vector<std::uint32_t>& found,
                                    const Guess& guess) const {
        const Across across(guess.axis);
        double nearest = guess.circle.radius;
        for (const std::uint32_t f : found) {
            const Eigen::Vector2d normal = across(facets_[f].normal);
            const Eigen::Vector2d any =
                across(mesh_.points[facets_[f].points[0]]) - guess.circle.centre;
            nearest = std::min(nearest, std::abs(normal.dot(any)));
        }
        return guess.circle.radius - nearest;
    }

    /// Facets with two sides along the axis, by different directions.
    [[nodiscard]] int strips_among(const std::vector<std::uint32_t>& found,
                                   const Guess& guess) const {
        const Across across(guess.axis);
        int strips = 0;
        for (const std::uint32_t f : found) {
            strips += f < flat_count_ && sides_of(f, across) ? 1 : 0;
        }
        return strips;
    }

    void keep(const std::vector<std::uint32_t>& found, const Guess& guess, double sagitta_mm) {
        const Across across(guess.axis);
        CylinderSurface cylinder;
        cylinder.axis = guess.axis;
        cylinder.radius_mm = guess.circle.radius;
        double lowest = INFINITY;
        for (const std::uint32_t p : points_of(found)) {
            lowest = std::min(lowest, guess.axis.dot(mesh_.points[p]));
        }
        cylinder.origin = across.u * guess.circle.centre.x() + across.v * guess.circle.centre.y() +
                          lowest * guess.axis;
        Region region{cylinder, guess.outward, 0, sagitta_mm};
        for (const std::uint32_t f : found) {
            taken_[f] = true;
            region.area_mm2 += facets_[f].area_mm2;
            for (const std::uint32_t t : facets_[f].triangles) {
                regions_.of[t] = static_cast<std::int32_t>(regions_.all.size());
            }
        }
        regions_.all.push_back(region);
    }

    const mesh::TriMesh& mesh_;
    const part::Part& part_;
    const Adjacency& adjacency_;
    const RegionOptions& options_;
    Regions& regions_;
    std::uint32_t flat_count_ = 0;  ///< facets below are flat regions, the others triangles
    std::vector<Facet> facets_;
    std::vector<std::uint32_t> facet_of_;
    std::vector<bool> taken_;
    std::vector<std::uint32_t> mark_;
    std::uint32_t stamp_ = 0;
};

}  // namespace

void find_cylinders(const part::Part& part, const Adjacency& adjacency,
                    const RegionOptions& options, Regions& regions) {
    CylinderFinder(part, adjacency, options, regions).find();
}

}  // namespace decomp::solid
