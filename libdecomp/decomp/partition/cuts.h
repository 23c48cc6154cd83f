// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/cut/complex.h"
#include "decomp/partition/partition.h"
#include "decomp/partition/votes.h"

#include <vector>

/// Inside the room: the order of cuts.
namespace decomp::partition {

/// Cuts the complex by the planes of the sheets until no cut gains any more: among those that gain
/// about as much as the best, the one that gains the thickest piece goes first, so that necks and
/// heads come off before the sides and shield them. Planes are nudged at their first cut, in
/// `sheets`.
[[nodiscard]] Result<std::vector<Atom>> cut_by_votes(cut::Complex& complex, const Ballot& ballot,
                                                     sheets::Sheets& sheets,
                                                     const PartitionOptions& options,
                                                     Figures& figures, const Run& run);

}  // namespace decomp::partition
