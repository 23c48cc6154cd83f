// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/run.h"
#include "decomp/labels/energy.h"
#include "decomp/labels/label.h"

/// Inside the room: makes labellings valid.
namespace decomp::labels {

/// Changes the labels until they are valid and no boundary turns back, or until nothing helps any
/// more; returns the best that was found, never worse than `labels`. In each round operators around
/// what is wrong are tried, each solved again nearby with everything else frozen, and the one is
/// kept that removes most for the least loss of energy. At most 120 rounds and 4000 trials.
/// Deterministic.
[[nodiscard]] Labeling repaired(const Energy& energy, Labeling labels, const Run& run);

/// The baseline: charts that are invalid lose their label, again and again, up to 40 times.
[[nodiscard]] Labeling thinned_out(const Energy& energy, Labeling labels, const Run& run);

}  // namespace decomp::labels
