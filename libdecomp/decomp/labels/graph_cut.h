// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/energy.h"

#include <span>
#include <vector>

/// Inside the room: labellings of least energy.
namespace decomp::labels {

/// Lowers energy plus `extra` (a cost for each facet and label) from the given labels on, by alpha
/// expansion (Boykov, Veksler, Zabih 2001). Only the labels of the facets `active` (distinct)
/// change. Deterministic. Some 10 us per active facet.
void lower(const Energy& energy, std::span<const LabelCosts> extra,
           std::span<const std::uint32_t> active, Labeling& labels);

}  // namespace decomp::labels
