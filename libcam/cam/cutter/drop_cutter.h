// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/cutter/surface.h"
#include "cam/tool/outline.h"

#include <Eigen/Core>

#include <limits>
#include <vector>

namespace cam::cutter {

inline constexpr double kFree = -std::numeric_limits<double>::infinity();

/// Lowers one outline onto a surface. Many may share a surface, and threads may share one of them.
class DropCutter {
  public:
    /// @param surface  must outlive this
    DropCutter(const Surface& surface, const tool::Outline& outline);

    /// How low the tool's tip may go with its axis at `at`: the outline then touches the surface
    /// and cuts nothing of it. `floor` where the surface would let it go lower: a high floor makes
    /// the call cheap.
    /// Exact up to rounding, 1e-9 mm. Cost: the facets under the outline that may hold it, some
    /// dozens.
    [[nodiscard]] double lowest_tip(const Eigen::Vector2d& at, double floor = kFree) const;

    /// Whether the tip may stand at this height. Cheaper than lowest_tip(): one fault suffices.
    [[nodiscard]] bool clears(const Eigen::Vector2d& at, double z) const;

    [[nodiscard]] const tool::Outline& outline() const { return outline_; }

  private:
    struct Drop;
    struct Candidate;

    /// Part of an edge.
    struct Span {
        double low;
        double high;
    };

    enum class Kind { Flat, Ball, Other };

    [[nodiscard]] bool may_hold(double top, double away_squared, double tip) const;
    [[nodiscard]] double tip_on_plane(const Surface::Facet& facet, const Drop& drop) const;
    [[nodiscard]] bool holds_inside(const Surface::Facet& facet, const Drop& drop) const;
    [[nodiscard]] double place_on(const Surface::Edge& edge, double distance, double rim) const;
    void lower(Drop& drop) const;
    void collect_cells(const Drop& drop, std::vector<Candidate>& candidates) const;
    void lower_on_cell(int column, int row, Drop& drop) const;
    void lower_on_edge(const Surface::Edge& edge, Drop& drop) const;
    [[nodiscard]] double best_along(double distance, double slope) const;
    [[nodiscard]] double best_on_corner(double distance, double slope, Span span) const;
    [[nodiscard]] double height(double r) const;

    const Surface* surface_;
    tool::Outline outline_;
    Kind kind_ = Kind::Other;
    double corner_end_ = 0;    ///< radius at which the corner ends
    double corner_end_z_ = 0;  ///< and its height there
    double cone_slope_ = 0;    ///< height per radius beyond it; infinite without a cone
    double rim_z_ = 0;         ///< height at the radius
};

}  // namespace cam::cutter
