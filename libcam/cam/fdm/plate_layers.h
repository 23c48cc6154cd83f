// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"
#include "cam/profile/read_profile.h"

#include <Eigen/Core>

#include <vector>

namespace cam::fdm {

/// A part's layers and where its frame's origin lies on the bed. Not owned: must outlive the call.
struct PlacedStack {
    const path::LayerStack* stack = nullptr;
    Eigen::Vector2d offset_mm = Eigen::Vector2d::Zero();
};

/// The layers of a whole plate: the parts' beads moved to their places and interleaved by height,
/// on each layer part after part by the shorter way. A skirt runs round all parts on the first
/// layer, unless the profile asks for brims.
[[nodiscard]] path::LayerStack merge_layers(const std::vector<PlacedStack>& parts,
                                            const profile::FdmSetup& setup);

}  // namespace cam::fdm
