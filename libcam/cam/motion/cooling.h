// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"
#include "cam/profile/read_profile.h"

namespace cam::motion {

/// Slows the beads of every layer that would take less than the material's minimum time, all by the
/// same factor, down to its minimum speed at most; what then still lacks is waited for, where the
/// dialect can. Cooling twice is cooling once (to 1e-3 of the
/// time). Deterministic, serial; costs some 20 estimates of each short layer.
[[nodiscard]] path::LayerStack cooled(path::LayerStack stack, const profile::FdmSetup& setup);

}  // namespace cam::motion
