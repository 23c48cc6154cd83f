// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

namespace decomp::mesh {

/// Moments of the solid inside a closed mesh of unit density.
struct Moments {
    double volume_mm3 = 0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of mass
    Eigen::Matrix3d covariance =
        Eigen::Matrix3d::Zero();  ///< of the solid's points about the centre, mm^2
    Eigen::Matrix3d axes =
        Eigen::Matrix3d::Identity();  ///< columns: principal axes, longest extent first
};

/// O(n), by signed tetrahedra about the centre of the bounds. Signs of the axes: largest component
/// positive.
[[nodiscard]] Moments moments(const TriMesh& mesh);

}  // namespace decomp::mesh
