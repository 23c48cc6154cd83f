// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/facets.h"
#include "decomp/labels/labeling.h"

#include <cstdint>
#include <vector>

/// Inside the room: the chart graph of a labelling.
namespace decomp::labels {

/// A connected set of facets with one label.
struct Chart {
    AxisLabel label = AxisLabel::PlusX;
    double area = 0;                        ///< mm^2
    std::vector<std::uint32_t> neighbours;  ///< charts across its boundaries, ascending
    /// What its boundary loops lack of being rectilinear: each needs two different neighbours along
    /// either other axis.
    int deficiency = 0;
    int loops = 0;
};

/// A chain of edges between two charts, from corner to corner.
struct Boundary {
    std::uint32_t left = 0;  ///< chart on its left, seen from outside; left < right
    std::uint32_t right = 0;
    std::vector<std::uint32_t> vertices;  ///< in order; first == last where it has no corner
    std::vector<std::uint32_t> facets;    ///< of the left chart, one for each edge
    bool closed = false;                  ///< runs back into itself without any corner
};

/// Where a boundary turns back along the axis in which it should run.
struct TurningPoint {
    std::uint32_t vertex = 0;
    std::uint32_t boundary = 0;
    int axis = 0;
    int direction = 0;  ///< +1: a maximum of the coordinate, -1: a minimum
};

struct Layout {
    std::vector<std::uint32_t> chart_of;  ///< for each facet
    std::vector<Chart> charts;
    std::vector<Boundary> boundaries;
    std::vector<std::uint32_t> corners;      ///< vertices where three boundaries or more meet
    std::vector<std::uint32_t> bad_corners;  ///< of them, those with more than three
    std::vector<TurningPoint> turning_points;
    std::vector<std::uint32_t> opposite;  ///< boundaries between charts with opposite labels

    /// 0 when the labelling is locally valid.
    [[nodiscard]] int violations() const;
};

/// O(facets). Turning points need a prominence of 1.5 % of the diagonal to count.
[[nodiscard]] Layout layout_of(const Facets& facets, const Labeling& labels);

/// Coordinate along which the boundary of two labels runs; -1 for labels of one axis.
[[nodiscard]] constexpr int run_axis(AxisLabel a, AxisLabel b) {
    return axis_of(a) == axis_of(b) ? -1 : 3 - axis_of(a) - axis_of(b);
}

}  // namespace decomp::labels
