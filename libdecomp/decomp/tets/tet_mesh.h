// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace decomp::tets {

/// Indices of four points; positive: (p1 - p0) x (p2 - p0) . (p3 - p0) > 0.
using Tet = std::array<std::uint32_t, 4>;

/// A tetrahedral mesh: points in mm.
struct TetMesh {
    std::vector<Eigen::Vector3d> points;
    std::vector<Tet> tets;
};

/// A shape and its polycube: the same tets over two sets of points. Tets are positive in the shape;
/// in the polycube some may be flat or inverted, and it may overlap itself.
struct Pair {
    std::vector<Eigen::Vector3d> shape;     ///< mm, model frame
    std::vector<Eigen::Vector3d> polycube;  ///< mm, polycube space: one point for each of `shape`
    std::vector<Tet> tets;
};

/// The planes of a polycube: the coordinates, ascending and distinct, at which its faces lie along
/// each axis of polycube space. The outermost two bound it.
struct Lattice {
    std::array<std::vector<double>, 3> planes;
};

}  // namespace decomp::tets
