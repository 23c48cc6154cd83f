// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/visibility/sight.h"
#include "decomp/base/run.h"
#include "decomp/part/part.h"

#include <Eigen/Core>

#include <vector>

namespace cam::check {

/// One definition of the ends of a part about an axis: facets whose normal is this near to it
/// (cosine, 8.1 degrees). No direction across the axis sees them well.
inline constexpr double kEndCosine = 0.99;

struct AxisOptions {
    int angles = 40;        ///< positions of A, at most visibility::kMostDirections
    int samples = 1500;     ///< facets that the coarse search looks at
    int directions = 1024;  ///< over the sphere, of the coarse search
    int spread = 600;       ///< axes evenly over the half sphere among the candidates
    int refined = 24;       ///< best candidates that are looked at with all angles
    int finalists = 5;      ///< of them, those looked at with all facets
};

/// A rotary axis and what it leaves, percent of the part's area.
struct AxisChoice {
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
    double unseen_percent = 0;    ///< not seen from any angle, ends excluded
    double open_end_percent = 0;  ///< unseen ends that no saw makes: see closed_ends()
    double stock_mm3 = 0;         ///< of the smallest cylinder
};

/// Axes for a part, best first: those of the cut faces and large flats, the model's, the principal
/// ones, the lattice's diagonals, and some spread evenly. Coarse: a map of what sample facets see
/// of the sphere, from which each axis' ring is read; then all angles for the best; then all facets
/// for the finalists, polished by small turns. What counts is unseen_percent + open_end_percent in
/// steps of 0.02, then the stock's volume, then the order above. Deterministic. Cost: 0.5 million
/// rays, and two of them a facet for each finalist.
[[nodiscard]] std::vector<AxisChoice> search_axes(const decomp::part::Part& part,
                                                  const visibility::Sight& sight,
                                                  const AxisOptions& options,
                                                  const decomp::Run& run);

/// Ends that need no tool: cut faces, and what lies in the plane of the part's end along the axis,
/// where it is sawn off flat. One entry for each facet.
[[nodiscard]] std::vector<char> closed_ends(const decomp::part::Part& part,
                                            const decomp::mesh::Facets& facets,
                                            const Eigen::Vector3d& axis);

/// One axis with all facets. @param axis  unit length
[[nodiscard]] AxisChoice measure_axis(const decomp::part::Part& part,
                                      const visibility::Sight& sight, const Eigen::Vector3d& axis,
                                      int angles, const decomp::Run& run);

}  // namespace cam::check
