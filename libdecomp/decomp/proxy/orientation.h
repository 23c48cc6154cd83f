// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <vector>

namespace decomp::proxy {

/// Area-weighted mean of |n_x| + |n_y| + |n_z| over the rotated normals: 1 when every facet faces
/// along an axis, at most sqrt(3) (Huang et al. 2014).
[[nodiscard]] double misalignment(const mesh::TriMesh& surface, const Eigen::Matrix3d& rotation);

/// Rotations (polycube frame from model frame) in which a labelling is worth trying: [0] is the
/// identity; then, best first, local optima of the misalignment; then the principal axes of the
/// surface; then its smallest box. No two lie within 10 degrees of each other, a quarter turn about
/// an axis counted as no turn; only the best optimum may lie nearer to the identity. At most 6.
/// 2000 fixed samples: the same input gives the same rotations. Cost: 0.05 s.
[[nodiscard]] std::vector<Eigen::Matrix3d> orientation_candidates(const mesh::TriMesh& surface);

}  // namespace decomp::proxy
