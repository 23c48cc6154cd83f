// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

/// Inside the room: which of several solids holds a point.
namespace decomp::partition {

/// Solids that do not overlap, sorted into a grid for rays along +Z. In doubles: a point within
/// rounding of a surface may be told to lie on either side.
class Locator {
  public:
    explicit Locator(std::vector<const mesh::TriMesh*> solids);

    /// Index of the solid around the point, or -1.
    [[nodiscard]] int locate(const Eigen::Vector3d& point) const;

  private:
    struct Facet {
        Eigen::Vector3d a, b, c;
        int solid;
    };

    [[nodiscard]] std::size_t column(double x) const;
    [[nodiscard]] std::size_t row(double y) const;

    std::vector<Facet> facets_;
    std::vector<std::vector<std::uint32_t>> grid_;
    Eigen::Vector3d low_;
    Eigen::Vector3d high_;
    std::size_t side_ = 1;
};

}  // namespace decomp::partition
