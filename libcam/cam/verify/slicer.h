// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/bitmap.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace cam::verify {

/// The cross-section of a part at one height.
struct Section {
    std::vector<std::array<double, 4>> edges;  ///< x0 y0 x1 y1, the inside on the left
    Eigen::AlignedBox2d bounds;
};

/// Cuts one mesh at any height. Points on the plane count as above it, so sections of closed meshes
/// are closed.
class Slicer {
  public:
    /// Sorts the triangles into bins by height. O(n).
    explicit Slicer(const decomp::mesh::TriMesh& mesh);

    [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }

    /// O(triangles of one bin).
    [[nodiscard]] Section at(double z) const;

  private:
    const decomp::mesh::TriMesh* mesh_;
    Eigen::AlignedBox3d bounds_;
    double bin_mm_ = 1;
    std::vector<std::uint32_t> starts_;
    std::vector<std::uint32_t> triangles_;
};

/// Sets the pixels whose centres have a winding number above zero.
void fill_section(const Section& section, double pixel_mm, Bitmap& bitmap);

/// Sets the pixels within `radius_mm` of the outline.
void draw_outline(const Section& section, double radius_mm, double pixel_mm, Bitmap& bitmap);

}  // namespace cam::verify
