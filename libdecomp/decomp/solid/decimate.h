// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/run.h"
#include "decomp/solid/regions.h"

namespace decomp::solid {

struct DecimateOptions {
    double tolerance_mm = 0.05;
    std::size_t max_faces = 6000;
};

struct Decimated {
    part::Part part;
    std::vector<std::int32_t> region_of;  ///< of each triangle, in the regions before
    std::size_t removed_points = 0;
    double farthest_mm = 0;  ///< from sample points of either surface to the other
};

/// Takes points out of a mesh, cheapest first, until its faces are few enough or nothing more can
/// go within the tolerance. Points are never moved. Points of curved regions and corners of flat
/// ones stay; a point on the rim of a flat region goes along the rim only, so that the region stays
/// flat and keeps its outline within the tolerance. O(n log n).
/// @error run.cancelled
[[nodiscard]] Result<Decimated> decimate(const part::Part& part, const Adjacency& adjacency,
                                         const Regions& regions, const DecimateOptions& options,
                                         const Run& run);

}  // namespace decomp::solid
