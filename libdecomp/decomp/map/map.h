// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/labels/labeling.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/tets/measure.h"
#include "decomp/tets/tet_mesh.h"

#include <cstddef>

namespace decomp::map {

struct MapOptions {
    int arap_rounds = 10;
    int rounds = 24;             ///< of the untangling parameter, at most
    int iterations = 200;        ///< of L-BFGS in each round, at most
    int budget = 1000;           ///< of L-BFGS iterations for one try
    std::size_t hopeless = 100;  ///< flips that are left as they are, without recovery
    int recoveries = 1;          ///< times that a map with flips is made again from a relaxed start
};

/// The tets of a shape and their place in the polycube. Charts are exactly flat: their points have
/// bitwise equal coordinates along the chart's axis.
struct MapResult {
    tets::Pair pair;
    labels::Labeling labels;  ///< of the pair's boundary facets, in boundary order
    tets::Measures measures;
    std::size_t splits = 0;  ///< edges that were split because no map could satisfy them
    int iterations = 0;      ///< of L-BFGS in all
};

/// Maps tets so that every facet labelled +-d lies in a plane normal to axis d: edges that could
/// not be satisfied are split, as-rigid-as-possible start, then the foldover-free energy with a
/// falling epsilon; around tets that stay flipped the mesh is refined and the map goes on. Tets
/// that stay flipped after that are left to the caller (measures.flips). Any labeling is accepted;
/// invalid ones give flips or flat parts.
/// @param tets     points [0, surface.points.size()) are the surface's; its boundary is the surface
/// @param labels   one for each triangle of the surface
/// @error map.labels  not as many labels as triangles, or a triangle that is no facet of the tets
/// Cost: 0.1 to 1 s for 15 000 tets, serial, counted. Source: Garanzha et al. 2021.
[[nodiscard]] Result<MapResult> map_to_polycube(const tets::TetMesh& tets,
                                                const mesh::TriMesh& surface,
                                                const labels::Labeling& labels,
                                                const MapOptions& options, Run& run);

}  // namespace decomp::map
