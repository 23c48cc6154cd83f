// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/labels/label.h"
#include "decomp/labels/labeling.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/tets/tet_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace decomp::polycube {

struct GenerateOptions {
    double compactness = 5;  ///< 1 to 10 as in PolyCut; below 1 (above 0): more detail than the
                             ///< normals hold
    std::optional<Eigen::Matrix3d> rotation;  ///< polycube frame from model frame; none: chosen
    int target_parts = 0;         ///< above 0: compactness is searched for about so many blocks
    int proxy_triangles = 3500;   ///< 0: from the local thickness
    int starts = 5;               ///< 1 to 5: labelings that compete
    bool deformed_starts = true;  ///< false: no labeling of deformed normals
    labels::RepairMode repair = labels::RepairMode::Constructive;
};

/// What the chosen polycube is like, as its maker counts; check_pair() counts anew.
struct Figures {
    std::string start;  ///< which labeling won
    int tried = 0;      ///< how many were mapped
    std::size_t proxy_triangles = 0;
    double proxy_distance_mm = 0;
    int charts = 0;
    int corners = 0;
    int turning_points = 0;
    bool valid_labels = false;
    double fidelity = 0;
    std::size_t tets = 0;
    std::size_t flips = 0;
    std::size_t folds = 0;  ///< facets of the boundary that look against their label
    double flipped_share = 0;
    double symmetric_dirichlet = 0;
    int cells = 0;
    double fragment_share = 0;
    double vote_error = 0;  ///< of the partition, where one was asked for
    double score = 0;       ///< by which starts compete: lower is better
};

struct Polycube {
    tets::Pair pair;  ///< shape in the model frame, polycube in its own
    tets::Lattice lattice;
    labels::Labeling labels;   ///< of the pair's boundary facets, in boundary order
    Eigen::Matrix3d rotation;  ///< polycube frame from model frame
    std::string tier;          ///< T1 to T4, see README; as the maker sees it
    Figures figures;
};

/// The share of the votes that a partition by this map would mislabel: a score for starts. May be
/// empty. Called from several threads.
using VoteError =
    std::function<double(const tets::Pair&, const tets::Lattice&, const mesh::TriMesh& volume)>;

/// Makes the polycube of a closed volume. A coarse proxy is filled with tets; up to five labelings
/// of its surface (direct, smoothed, of deformed normals) are mapped, and the one with the least of
/// invalid labels, turning points, flips, fragments and vote error wins. The later ones are tried
/// only where the first leaves something to be desired. No closed volume is refused: where nothing
/// else works, the map is the identity and the lattice has planes at cross-section events (T4).
/// @param volume  closed, manifold, outward, free of self-intersection
/// @error polycube.options, run.cancelled
/// Cost: 2 to 6 CPU-seconds, whatever the size of the volume. The same at any number of threads.
[[nodiscard]] Result<Polycube> generate(const mesh::TriMesh& volume, const GenerateOptions& options,
                                        const VoteError& vote_error, Run& run);

}  // namespace decomp::polycube
