// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/millproof/heights.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cam::millproof {

/// The inside of the part: how deep below its surface a point lies.
class Solid {
  public:
    /// @param part  outward, must outlive this. O(n).
    explicit Solid(const decomp::mesh::TriMesh& part);

    /// Whether a point lies inside: more triangles above it look up than down.
    /// Cost: the triangles over one square millimetre.
    [[nodiscard]] bool holds(const Eigen::Vector3d& at) const;

    /// The distance (mm) from a point inside to the nearest triangle, at most `limit`; 0 outside.
    /// Cost: the triangles within `limit` in plan.
    [[nodiscard]] double depth(const Eigen::Vector3d& at, double limit) const;

  private:
    [[nodiscard]] double nearest_over(std::size_t cell, const Eigen::Vector3d& at) const;
    [[nodiscard]] int column_of(double x) const;
    [[nodiscard]] int row_of(double y) const;

    const decomp::mesh::TriMesh& part_;
    Nodes cells_;
    std::vector<std::vector<std::uint32_t>> triangles_;  ///< that come over a cell
};

}  // namespace cam::millproof
