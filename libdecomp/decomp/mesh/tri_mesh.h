// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace decomp::mesh {

using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle mesh: points in mm, triangles counter-clockwise seen from outside.
struct TriMesh {
    std::vector<Eigen::Vector3d> points;
    std::vector<Triangle> triangles;
};

}  // namespace decomp::mesh
