// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/fdm/infill.h"
#include "cam/polygon/polygon.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace cam::fdm {

/// Where the outer walls begin and end.
enum class SeamPlace {
    Hidden,   ///< on faces that touch another part, else in sharp concave corners, else at sharp
              ///< corners; among equals, above the seam of the layer below
    Aligned,  ///< at sharp corners, above the seam of the layer below
    Rear,     ///< as far back as possible
    Nearest,  ///< where the nozzle is: left to the order of printing
};

/// As the profile names it. An unknown name is a bug: profiles are checked when they are read.
[[nodiscard]] SeamPlace seam_place(const std::string& name);

/// Chooses seams from the bed upwards.
class SeamPlanner {
  public:
    /// @param reach_mm  distance of an outer wall's centre from the mating face that it stands for
    SeamPlanner(SeamPlace place, double reach_mm) : place_(place), reach_mm_(reach_mm) {}

    /// Turns closed loops (first point = last point, material on the left) such that they begin at
    /// their seams; may add a vertex there. @param mating  lines, see mating_lines()
    void place_seams(std::vector<Line>& loops, const polygon::Paths& mating);

  private:
    [[nodiscard]] double distance_to_last(const Eigen::Vector2d& p) const;

    SeamPlace place_;
    double reach_mm_;
    std::vector<Eigen::Vector2d> last_;  ///< seams of the layer below
};

}  // namespace cam::fdm
