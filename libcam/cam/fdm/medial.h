// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"

#include <Eigen/Core>

#include <vector>

namespace cam::fdm {

/// A point in the middle of a strip, and the strip's width there.
struct MedialPoint {
    Eigen::Vector2d at_mm = Eigen::Vector2d::Zero();
    double width_mm = 0;
};

using MedialLine = std::vector<MedialPoint>;

/// The middle lines of narrow strips: the medial axis of the region, without its branches into
/// blunt corners and where the strip is narrower than `least_width_mm`. O(n log n): Voronoi diagram
/// of the boundary's edges.
[[nodiscard]] std::vector<MedialLine> medial_lines(const polygon::Paths& region,
                                                   double least_width_mm);

/// A stretch of a middle line along which one width will do.
struct MedialPiece {
    std::vector<Eigen::Vector2d> points;
    double width_mm = 0;  ///< the strip's mean
};

/// Cuts a line into pieces whose width varies by no more than `step_mm`.
[[nodiscard]] std::vector<MedialPiece> pieces_of_one_width(const MedialLine& line, double step_mm);

}  // namespace cam::fdm
