// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/motion/cooling.h"

#include "cam/motion/estimate.h"
#include "cam/motion/moves.h"

#include <algorithm>

namespace cam::motion {

namespace {

double layer_seconds(const path::Layer& layer, const profile::FdmSetup& setup) {
    return estimate({{layer}}, setup).seconds;
}

/// The layer with every bead at `factor` of the speed that it has now, but not below the floor.
path::Layer slowed(path::Layer layer, double factor, const profile::FdmSetup& setup) {
    for (path::Bead& bead : layer.beads) {
        const double now = bead_speed_mm_per_s(bead, setup);
        const double floor = std::min(now, setup.material.min_speed.mm_per_s());
        bead.speed = decomp::Speed::mm_per_s(std::max(now * factor, floor));
    }
    return layer;
}

/// The layer slowed just enough to take the wanted time, or as far as it may be.
path::Layer slowed_to(double wanted_s, const path::Layer& layer, const profile::FdmSetup& setup) {
    constexpr int kHalvings = 16;
    // Accelerations keep the time from being proportional to 1 / factor, but it grows as the factor
    // falls.
    double slow = 0;
    double fast = 1;
    path::Layer best = slowed(layer, slow, setup);
    if (layer_seconds(best, setup) <= wanted_s) {
        return best;
    }
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = (slow + fast) / 2;
        path::Layer candidate = slowed(layer, middle, setup);
        if (layer_seconds(candidate, setup) >= wanted_s) {
            slow = middle;
            best = std::move(candidate);
        } else {
            fast = middle;
        }
    }
    return best;
}

}  // namespace

path::LayerStack cooled(path::LayerStack stack, const profile::FdmSetup& setup) {
    // Close enough: below what anybody could measure, and a second pass leaves the layer alone.
    constexpr double kCloseEnough = 1e-3;
    const double wanted_s = setup.material.min_layer_time_s;
    for (path::Layer& layer : stack.layers) {
        if (!layer.beads.empty() && layer_seconds(layer, setup) < wanted_s * (1 - kCloseEnough)) {
            layer = slowed_to(wanted_s, layer, setup);
            const double lacking_s = wanted_s - layer_seconds(layer, setup);
            if (!setup.dialect.dwell.empty() && lacking_s > wanted_s * kCloseEnough) {
                layer.pause_s += lacking_s;
            }
        }
    }
    return stack;
}

}  // namespace cam::motion
