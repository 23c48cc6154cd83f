// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/millproof/envelope.h"
#include "cam/millproof/reach.h"

namespace cam::millproof {

/// Looks at points of the part's surface: what was cut away of it, what stands on it.
void examine_surface(const MillJob& job, const ProofOptions& options,
                     const std::vector<Step>& steps, MillProof& proof);

}  // namespace cam::millproof
