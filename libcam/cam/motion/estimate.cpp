// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/motion/estimate.h"

#include "cam/motion/planner.h"

#include <numbers>

namespace cam::motion {

std::size_t PieceCounter::piece_of(const Move& move) {
    const bool printed = bead_ != nullptr;
    const bool same = move.kind == MoveKind::Extrude && move.bead == bead_;
    if (move.layer != layer_ || (printed && !same)) {
        ++piece_;
        bead_ = nullptr;
        layer_ = move.layer;
    }
    if (move.kind == MoveKind::Extrude) {
        bead_ = move.bead;
    }
    return piece_;
}

Estimate estimate(const path::LayerStack& stack, const profile::FdmSetup& setup) {
    const profile::FdmMachine::Motion& motion = setup.machine.motion;
    Estimate out;
    Planner planner(motion);
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    bool placed = false;
    PieceCounter counter;
    std::vector<double> pauses;
    std::vector<std::size_t> layers;  // of each piece
    trace(stack, setup, [&](const Move& move) {
        // Where the machine comes from is not known: the way to the first bead takes no time.
        if (!placed) {
            at = move.to;
            placed = move.kind == MoveKind::Travel;
        }
        const std::size_t piece = counter.piece_of(move);
        pauses.resize(piece + 1, 0.0);
        layers.resize(piece + 1, move.layer);
        pauses[piece] += move.seconds;
        Segment segment;
        segment.delta_mm << move.to - at, move.filament_mm;
        segment.speed_mm_per_s = move.speed_mm_per_s;
        segment.acceleration_mm_per_s2 = move.kind == MoveKind::Extrude
                                             ? motion.print_acceleration_mm_per_s2
                                             : motion.travel_acceleration_mm_per_s2;
        segment.slot = piece;
        planner.add(segment);
        at = move.to;
        if (move.kind == MoveKind::Extrude) {
            out.filament_mm += move.filament_mm;
        }
    });
    out.piece_seconds = planner.finish();
    out.piece_seconds.resize(pauses.size(), 0.0);
    out.layer_seconds.resize(stack.layers.size(), 0.0);
    for (std::size_t i = 0; i < pauses.size(); ++i) {
        out.piece_seconds[i] += pauses[i];
        out.layer_seconds[layers[i]] += out.piece_seconds[i];
        out.seconds += out.piece_seconds[i];
    }
    const double radius_mm = setup.machine.nozzle.filament_diameter_mm / 2;
    const double volume_cm3 = out.filament_mm * std::numbers::pi * radius_mm * radius_mm / 1000;
    out.filament_g = volume_cm3 * setup.material.density_g_per_cm3;
    out.cost = out.filament_g / 1000 * setup.material.cost_per_kg;
    return out;
}

}  // namespace cam::motion
