// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <vector>

namespace cam::verify {

/// How high material stands in the chamber, in printing order: the centre lines of the beads on a
/// 0.4 mm grid.
class PrintedHeights {
  public:
    PrintedHeights(const Eigen::Vector2d& min_mm, const Eigen::Vector2d& max_mm);

    /// How far the nozzle dips below printed material on its way from a to b; 0 or less when it
    /// does not. O(cells).
    [[nodiscard]] double depth(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

    /// Material up to the nozzle along a-b.
    void raise(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

  private:
    template <class Body>
    void for_cells(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Body& body) const;

    Eigen::Vector2d min_;
    double cell_mm_ = 0.4;
    int columns_ = 1;
    int rows_ = 1;
    std::vector<float> top_;
};

}  // namespace cam::verify
