// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/map/deform.h"
#include "decomp/polycube/generate.h"

#include <optional>
#include <string>
#include <vector>

namespace decomp::polycube {

/// The solid that labelings compete for: tets whose first points are the surface's, in the model
/// frame, and both turned into the polycube's.
struct Solid {
    mesh::TriMesh surface;
    tets::TetMesh tets;
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    mesh::TriMesh turned_surface;
    tets::TetMesh turned_tets;
    double proxy_distance_mm = 0;
};

/// One labeling to try.
struct Start {
    std::string name;
    double compactness = 5;
    int smoothing = 0;
    std::optional<map::DeformOptions> deform;  ///< none: the normals as they are
    labels::RepairMode repair = labels::RepairMode::Constructive;
};

/// Labels, maps, quantises and counts. @error those of label() and map_to_polycube()
[[nodiscard]] Result<Polycube> candidate(const Solid& solid, const Start& start,
                                         const mesh::TriMesh& volume, const VoteError& vote_error,
                                         Run& run);

/// Nothing to be desired: valid, no turning points, no flips, faithful.
[[nodiscard]] bool is_perfect(const Figures& figures);

/// Whether the map is of any use for choosing planes.
[[nodiscard]] bool is_usable(const Figures& figures);

/// Proxy and tets; the surface is sampled anew where gmsh fails. Turned by options.rotation, or by
/// the best candidate if that aligns the surface much better than it stands.
[[nodiscard]] Result<Solid> solid_of(const mesh::TriMesh& volume, const GenerateOptions& options,
                                     Run& run);

/// The identity as a map, with planes at cross-section events: needs no labels, and no tets but
/// those of voxels.
[[nodiscard]] Polycube identity_polycube(const mesh::TriMesh& volume,
                                         const Eigen::Matrix3d& rotation);

}  // namespace decomp::polycube
