// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/tets/tet_mesh.h"

#include <cstddef>
#include <span>

namespace decomp::tets {

/// Six times the signed volume of a tet, mm^3.
[[nodiscard]] double six_volumes(std::span<const Eigen::Vector3d> points, const Tet& tet);

/// The derivative of the map from shape to polycube in one tet: 3 x 3, det > 0 where it keeps the
/// sense.
[[nodiscard]] Eigen::Matrix3d jacobian(const Pair& pair, std::size_t tet);

/// How good a map is, in double arithmetic.
struct Measures {
    std::size_t tets = 0;
    std::size_t flips = 0;           ///< tets that are flat or inverted in the polycube
    double flipped_share = 0;        ///< their share of the shape's volume
    double least_determinant = 0;    ///< of the Jacobians
    double symmetric_dirichlet = 0;  ///< mean over the volume of tets with det > 1e-6, of
                                     ///< (|J|^2 + |J^-1|^2) / 6, singular values no less than
                                     ///< 1e-3: 1 for a rotation
    double volume_mm3 = 0;           ///< of the shape
    double polycube_mm3 = 0;         ///< of the polycube, inverted tets counting negative
};

/// O(n).
[[nodiscard]] Measures measure(const Pair& pair);

}  // namespace decomp::tets
