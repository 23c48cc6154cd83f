// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/frame.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/judge.h"
#include "decomp/part/part.h"

#include <string>
#include <vector>

namespace decomp::pipeline {

/// Every budget is counted, never timed, so that results do not depend on the speed of a machine.
struct DecomposeOptions {
    int max_parts = 200;         ///< more than these is an error
    int proxy_triangles = 5000;  ///< planes are searched on a simplified surface of this size
    int offsets = 11;   ///< evenly spaced planes tried along each direction, besides the events
    int lookahead = 4;  ///< best first cuts that are followed to the end
    double thin_share =
        0.015;  ///< of the diagonal: volume / interface below it is a tongue, taken only in need
    bool merge = true;  ///< unite neighbours afterwards where the judge allows
};

struct Decomposition {
    part::Assembly assembly;
    std::vector<Pose<PartBedFrame, ModelFrame>>
        poses;                            ///< one for each part: the one in which it was judged
    std::vector<part::Verdict> verdicts;  ///< one for each part; all ok
    std::string tier;                     ///< "T4": planes at cross-section events
    int cuts = 0;                         ///< planes used
    std::vector<std::string> notes;       ///< what a reader of the report should know
};

/// Cuts a volume until the judge is content with every part, then unites neighbours where it stays
/// content. A volume that already is fine comes back as one part for each of its bodies. Works for
/// every closed volume; the parts are an exact partition.
/// @param volume  closed, manifold, outward, free of self-intersection (see repair)
/// @param judge   must become content with small enough pieces
/// @error decompose.too_many_parts  the judge was not content with max_parts parts
/// @error decompose.no_progress     a region cannot be cut any further
/// @error any error of cut::Complex
[[nodiscard]] Result<Decomposition> decompose(const mesh::TriMesh& volume,
                                              const DecomposeOptions& options,
                                              const part::Judge& judge, Run& run);

}  // namespace decomp::pipeline
