// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/cut/complex.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/pipeline/decompose.h"
#include "decomp/pipeline/plan.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Inside the room: the boxes of a polycube as parts to begin with.
namespace decomp::pipeline {

/// Where a decomposition starts.
struct Start {
    explicit Start(cut::Complex made) : complex(std::move(made)) {}

    cut::Complex complex;
    std::map<std::int32_t, Hints> hints;  ///< by region
    std::string tier = "T4";
    std::vector<std::string> by;  ///< who decided each step of the complex
    bool keeps_regions = false;   ///< regions are not united afterwards
    std::optional<BoxFacts> facts;
};

/// Partitions the volume by the map of the options. Each part brings the planes of the sheets and
/// planes of the polycube between its sides as hints, should it have to be cut further.
/// @error decompose.bad_map  more than options.most_mislabeled of the votes lie in the wrong part,
/// and boxes need not be kept
/// @error those of partition()
[[nodiscard]] Result<Start> start_from_boxes(const mesh::TriMesh& volume,
                                             const DecomposeOptions& options, double nudge_share,
                                             Run& run);

}  // namespace decomp::pipeline
