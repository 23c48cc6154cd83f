// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/judge.h"
#include "decomp/pipeline/decompose.h"
#include "decomp/plan/plan.h"

/// Inside the room: plans carried out, and what a person changes of them.
namespace decomp::pipeline {

/// Carries out a plan, then the edits of the options in their order, and asks the judge about every
/// part. The plan of the result has the edits as further steps.
/// @error plan.other_shape, plan.no_such_region, plan.name_taken, plan.cut_misses,
/// plan.not_neighbours, plan.no_such_part, plan.no_polycube, plan.does_not_fit; those of
/// cut::Complex
[[nodiscard]] Result<Decomposition> by_hand(const mesh::TriMesh& volume, const plan::Plan& plan,
                                            const DecomposeOptions& options,
                                            const part::Judge& judge, Run& run);

}  // namespace decomp::pipeline
