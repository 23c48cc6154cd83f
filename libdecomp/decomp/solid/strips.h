// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/solid/circle_fit.h"
#include "decomp/solid/facets.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

/// Strips that chord a cylinder or a cone. Seen along the straight lines of such a surface it is a
/// circle, and the strips are chords of it.
namespace decomp::solid {

constexpr double kWidestStep =
    31 * std::numbers::pi / 180;  ///< of a circle of 12 chords, and a bit
constexpr double kNarrowestStep = 0.2 * std::numbers::pi / 180;  ///< below it, a plane
constexpr double kUneven = 3;                                    ///< between neighbouring strips
constexpr double kSeedOfSagitta = 0.05;
constexpr double kAlmost = 1e-3;  ///< radians between directions that are meant to be one

/// Straight lines of a surface, parallel to its axis or through its apex, and how space looks along
/// them: a plane square to the axis, in millimetres.
class Rulings {
  public:
    [[nodiscard]] static Rulings parallel(const Eigen::Vector3d& axis);

    /// @param height_mm of that plane above the apex
    /// @param near_mm points so near to the apex are the apex
    [[nodiscard]] static Rulings through(const ConeSurface& cone, double height_mm, double near_mm);

    /// Where the line through p meets the plane; far away for a point behind the apex.
    [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector3d& p) const;

    /// A direction or the normal of a plane that contains one of the lines.
    [[nodiscard]] Eigen::Vector2d across(const Eigen::Vector3d& direction) const {
        return {u_.dot(direction), v_.dot(direction)};
    }

    /// The point of a parallel bundle's plane through the frame's origin.
    [[nodiscard]] Eigen::Vector3d in_space(const Eigen::Vector2d& q) const {
        return q.x() * u_ + q.y() * v_;
    }

    /// Of the line through p; unit.
    [[nodiscard]] Eigen::Vector3d direction(const Eigen::Vector3d& p) const;

    /// A millimetre at p, square to the surface, appears as so many.
    [[nodiscard]] double magnified(const Eigen::Vector3d& p) const;

    /// The same in the plane itself.
    [[nodiscard]] double magnified() const { return 1 / slope_; }

    [[nodiscard]] bool is_apex(const Eigen::Vector3d& p) const;

    [[nodiscard]] const Eigen::Vector3d& axis() const { return axis_; }

  private:
    explicit Rulings(const Eigen::Vector3d& axis);

    Eigen::Vector3d axis_;
    Eigen::Vector3d u_;
    Eigen::Vector3d v_;
    Eigen::Vector3d apex_ = Eigen::Vector3d::Zero();
    double height_ = 0;  ///< 0: parallel
    double near_ = 0;
    double slope_ = 1;  ///< cosine of the angle between the lines and the axis
};

/// What the surface is while its facets are gathered.
struct Guess {
    Rulings rulings;
    CircleFit circle;  ///< seen along the rulings
    bool outward = true;
    double within_mm = 0;
    double reach_mm = 0;  ///< the most that within_mm may become
    double widest_mm =
        0;  ///< seen chord of a strip: a plane that touches the surface is none of it
};

/// Facets that have been found to chord one surface.
struct Chorded {
    std::vector<std::uint32_t> facets;
    Guess guess;
    double sagitta_mm = 0;
};

class Strips {
  public:
    Strips(Facets& facets, const RegionOptions& options) : facets_(facets), options_(options) {}

    /// The two sides of a strip along the rulings, as seen; nothing where a side is no line but a
    /// corner.
    [[nodiscard]] std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> sides_of(
        std::uint32_t f, const Rulings& rulings) const;

    /// Fits and gathers in turn until nothing changes. Nothing where that are fewer than three
    /// strips, or their points lie no better on the surface than the strips do.
    /// @param refit fits the guess to the facets and gives the median distance of their points
    [[nodiscard]] std::optional<Chorded> settle(
        Guess guess, std::uint32_t seed,
        const std::function<double(const std::vector<std::uint32_t>&, Guess&)>& refit);

    /// How far the strips stay behind the surface, at most.
    [[nodiscard]] double sagitta_of(const std::vector<std::uint32_t>& found,
                                    const Guess& guess) const;

    /// The median of the points' distances from a fitted surface is no more.
    [[nodiscard]] double rest_mm(double sagitta_mm) const;

    /// Points deviate from a surface that is not yet fitted by no more.
    [[nodiscard]] double reach_mm(double sagitta_mm) const;

  private:
    [[nodiscard]] bool chords(std::uint32_t f, const Guess& guess) const;
    [[nodiscard]] int strips_among(const std::vector<std::uint32_t>& found,
                                   const Guess& guess) const;

    Facets& facets_;
    const RegionOptions& options_;
};

/// The median of how far points are off, and those that are off by little more than it: points
/// which a cut has made lie on chords and drop out, those of the original surface remain.
struct Nearest {
    double median = 0;
    std::vector<std::size_t> near;
};

[[nodiscard]] Nearest nearest_of(const std::vector<double>& off, double planar_mm);

void find_cylinders(Facets& facets, const RegionOptions& options);

/// Lays cones on the axis of cylinders and cones beside them where it almost is theirs.
void align_cones(Facets& facets, const RegionOptions& options);

void find_cones(Facets& facets, const RegionOptions& options);

/// Joins cones and cylinders about one axis whose rims lie on a circle of the half plane through
/// it.
void find_tori(Facets& facets, const RegionOptions& options);

}  // namespace decomp::solid
