// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"

#include <cmath>
#include <numbers>

namespace tests {

/// A closed square bead with its lower left corner at (x, y).
inline cam::path::Bead square_bead(double x, double y, double side, double speed_mm_per_s = 45) {
    cam::path::Bead bead;
    bead.points = {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}, {x, y}};
    bead.width_mm = 0.45;
    bead.height_mm = 0.2;
    bead.speed = decomp::Speed::mm_per_s(speed_mm_per_s);
    return bead;
}

/// A closed many-cornered bead whose points lie on no grid.
inline cam::path::Bead round_bead(double x, double y, double radius, int corners) {
    cam::path::Bead bead = square_bead(0, 0, 1);
    bead.points.clear();
    for (int i = 0; i <= corners; ++i) {
        const double angle = 2 * std::numbers::pi * (i % corners) / corners;
        bead.points.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle));
    }
    return bead;
}

/// A tower of layers 0.2 mm thick, each with two walls and a second feature.
inline cam::path::LayerStack tower(int layers, double side = 40) {
    cam::path::LayerStack stack;
    for (int i = 0; i < layers; ++i) {
        cam::path::Layer layer;
        layer.z_mm = 0.2 * (i + 1);
        layer.height_mm = 0.2;
        layer.beads = {square_bead(-side / 2, -side / 2, side, 30),
                       square_bead(-side / 2 + 0.45, -side / 2 + 0.45, side - 0.9),
                       round_bead(0, 0, side / 3, 97)};
        layer.beads[1].feature = cam::path::Feature::InnerWall;
        layer.beads[2].feature = cam::path::Feature::SparseInfill;
        stack.layers.push_back(layer);
    }
    return stack;
}

}  // namespace tests
