// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/fdm/edge_grid.h"
#include "cam/path/layers.h"
#include "cam/polygon/polygon.h"

#include <Eigen/Core>

#include <vector>

namespace cam::fdm {

/// Finds ways of the nozzle over one layer that do not leave the part: straight where they can be,
/// else along the inside of the walls.
class TravelMap {
  public:
    /// @param walls_mm  how far inside the surface ways along it keep: over the second wall
    TravelMap(const polygon::Paths& slice, double width_mm, double walls_mm);

    /// The way from where one bead ended to where the next begins. Straight and not `inside` when
    /// there is no way within the part, or only one far longer than the straight one.
    [[nodiscard]] path::Approach approach(const Eigen::Vector2d& from,
                                          const Eigen::Vector2d& to) const;

  private:
    struct Node {
        Eigen::Vector2d at_mm;
        bool on_boundary = false;
        BoundaryPoint point;
    };

    [[nodiscard]] bool brought_in(const Eigen::Vector2d& p, Node& node) const;
    [[nodiscard]] bool leads_in(const Node& node, const Eigen::Vector2d& towards) const;
    [[nodiscard]] bool sees(const Node& a, const Node& b) const;
    [[nodiscard]] bool walk(const Node& from, const Node& to, std::vector<Node>& way) const;
    void follow(const BoundaryPoint& from, const BoundaryPoint& to, std::vector<Node>& way) const;
    [[nodiscard]] std::vector<Node> pulled_tight(const std::vector<Node>& way) const;

    double width_mm_;
    EdgeGrid surface_;  ///< just inside the surface: what a straight way must not cross
    std::vector<std::size_t> island_of_loop_;
    EdgeGrid inner_;  ///< where ways run along
};

/// Gives every bead its approach from the end of the one before.
void find_approaches(const TravelMap& map, std::vector<path::Bead>& beads);

}  // namespace cam::fdm
