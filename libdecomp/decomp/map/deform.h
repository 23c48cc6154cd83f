// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/tets/tet_mesh.h"

#include <vector>

namespace decomp::map {

/// How strongly normals are drawn to the axes. Detail grows along (0.1, 1), (0.3, 1), (1, 0.5),
/// (1, 0.3); beyond, smooth surfaces become staircases.
struct DeformOptions {
    double pull = 0.3;       ///< lambda: weight of the surface's L1 normals against rigidity
    double smoothing = 1.0;  ///< beta: weight of bends between neighbours, relative to `pull`
    int stages = 4;          ///< the pull doubles and the L1 norm sharpens in each
    int iterations = 60;     ///< of L-BFGS in each stage, at most
};

/// The unit normals of the surface's triangles after the solid has been deformed so that they turn
/// towards the axes: a start for the labeling that sees more than the normals as they are.
/// Flip-free by construction (a barrier); after Huang, Jiang, Shi, Tong, Bao, Desbrun 2014.
/// @param tets  points [0, surface.points.size()) are the surface's
/// Cost: 0.1 to 0.4 s for 15 000 tets, serial, counted.
[[nodiscard]] std::vector<Eigen::Vector3d> deformed_normals(const tets::TetMesh& tets,
                                                            const mesh::TriMesh& surface,
                                                            const DeformOptions& options,
                                                            const Run& run);

}  // namespace decomp::map
