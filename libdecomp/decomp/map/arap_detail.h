// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/map/constraints_detail.h"

namespace decomp::map {

/// A start for the map: as rigid as possible under the constraints (Sorkine, Alexa 2007, on tets),
/// `rounds` of fitted rotations and solved coordinates. Rotations by Mueller, Bender, Chentanez,
/// Macklin 2016; solves by conjugate gradients, counted. Returns the unknowns.
[[nodiscard]] Eigen::VectorXd arap_start(const tets::TetMesh& mesh, const Unknowns& unknowns,
                                         int rounds);

}  // namespace decomp::map
