// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/labeling.h"
#include "decomp/map/map.h"
#include "decomp/tets/tet_mesh.h"

namespace decomp::map {

/// The planes of a map's charts, near ones merged (Cherchi, Livesu, Scateni 2016): neighbours
/// closer than merge_share of the axis' extent become one at their mean, weighted by area, unless
/// solid lies between them. The outermost stay. At least two planes an axis.
[[nodiscard]] tets::Lattice quantise(const MapResult& map, double merge_share = 0.08);

/// As quantise(), for a pair made elsewhere: charts are the parts of the boundary that look along
/// an axis in the polycube, at the coordinate of their facets' centres; they need be neither
/// exactly flat nor integer.
[[nodiscard]] tets::Lattice lattice_of(const tets::Pair& pair, double merge_share = 0.08);

/// The label of each boundary facet of a pair made elsewhere, in boundary order: the axis along
/// which it looks in the polycube, outward by the sense of the pair as a whole.
[[nodiscard]] labels::Labeling labels_of(const tets::Pair& pair);

}  // namespace decomp::map
