// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/mill_machine.h"
#include "cam/tool/tool.h"
#include "decomp/base/result.h"
#include "decomp/mesh/facets.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace cam::check {

struct ReachOptions {
    double cell_mm = 0.1;       ///< of the height map
    double tolerance_mm = 0.1;  ///< at least 0.71 cells
    double shank_clearance_mm = 0.1;
    double holder_clearance_mm = 1;
};

/// What a mill's profile says of it.
[[nodiscard]] ReachOptions reach_options(const profile::MillMachine& machine);

/// Edges of the pieces into which large facets are cut before tools are tried: the least radius.
[[nodiscard]] double sample_spacing_mm(const std::vector<tool::Tool>& tools);

/// What one tool reaches from one direction, for each point that was asked.
struct Reach {
    std::vector<char> cutter;  ///< if nothing but the cutting part were in the way
    std::vector<char> tool;    ///< with shank and holder: never more than `cutter`
};

/// A point is reached when the tool, lowered along its axis until it touches the part, sweeps the
/// place that lies the tolerance above it, for some place of its axis. Points of facets that face
/// away are not.
///
/// The part is a height map, so what a facet sees along a ray is never less, up to a cell, than
/// what a tool reaches. Walls are reached by the flank, as far as the flutes go.
/// @param points     barycentres and normals of the mesh's facets, or of pieces of them (Samples)
/// @param direction  from the part to the spindle, unit length
/// @param floor_mm   height along `direction` below which nothing of the tool may go; none: no
///                   limit
/// @error check.raster_too_large
/// Cost: see tests/bench; deterministic, serial.
[[nodiscard]] decomp::Result<Reach> tool_reach(const decomp::mesh::TriMesh& mesh,
                                               const decomp::mesh::Facets& points,
                                               const Eigen::Vector3d& direction,
                                               const tool::Tool& tool, const ReachOptions& options,
                                               std::optional<double> floor_mm = std::nullopt);

}  // namespace cam::check
