// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/motion/moves.h"

#include <algorithm>
#include <numbers>

namespace cam::motion {

namespace {

class Tracer {
  public:
    Tracer(const profile::FdmSetup& setup, const std::function<void(const Move&)>& sink)
        : machine_(setup.machine), setup_(setup), sink_(sink) {}

    void print(const path::Layer& layer, std::size_t index) {
        move_.layer = index;
        emit(MoveKind::NewLayer, 0, 0);
        for (const path::Bead& bead : layer.beads) {
            if (bead.points.size() >= 2) {
                travel(bead.points.front(), layer.z_mm);
                extrude(bead);
            }
        }
    }

    void retract() {
        if (!retracted_ && machine_.retraction.length_mm > 0) {
            retracted_ = true;
            emit(MoveKind::Retract, -machine_.retraction.length_mm,
                 machine_.retraction.speed.mm_per_s());
        }
    }

  private:
    void emit(MoveKind kind, double filament_mm, double speed) {
        move_.kind = kind;
        move_.filament_mm = filament_mm;
        move_.speed_mm_per_s = speed;
        sink_(move_);
    }

    void lift_to(MoveKind kind, double z_mm) {
        if (move_.to.z() != z_mm) {
            move_.to.z() = z_mm;
            emit(kind, 0, machine_.motion.max_speed_mm_per_s.z());
        }
    }

    void travel(const Eigen::Vector2d& target, double z_mm) {
        const double distance_mm = (target - move_.to.head<2>()).norm();
        const bool same_height = started_ && z_mm == layer_z_mm_;
        if (same_height && distance_mm == 0) {
            return;
        }
        if (!same_height || distance_mm >= machine_.retraction.min_travel_mm) {
            retract();
            const double lift_mm = started_ ? machine_.retraction.lift_mm : 0.0;
            lift_to(MoveKind::Raise, std::min(std::max(z_mm, layer_z_mm_) + lift_mm,
                                              std::max(machine_.chamber.max_mm.z(), z_mm)));
        }
        if (distance_mm > 0 || !started_) {
            move_.to.head<2>() = target;
            emit(MoveKind::Travel, 0, machine_.process.travel_speed.mm_per_s());
        }
        lift_to(MoveKind::Lower, z_mm);
        started_ = true;
        layer_z_mm_ = z_mm;
    }

    void extrude(const path::Bead& bead) {
        if (retracted_) {
            retracted_ = false;
            emit(MoveKind::Recover, machine_.retraction.length_mm,
                 machine_.retraction.speed.mm_per_s());
        }
        const double per_mm = filament_per_mm(bead, setup_);
        const double speed = bead_speed_mm_per_s(bead, setup_);
        move_.bead = &bead;
        for (std::size_t i = 1; i < bead.points.size(); ++i) {
            const double length_mm = (bead.points[i] - move_.to.head<2>()).norm();
            if (length_mm > 0) {
                move_.to.head<2>() = bead.points[i];
                emit(MoveKind::Extrude, length_mm * per_mm, speed);
            }
        }
        move_.bead = nullptr;
    }

    const profile::FdmMachine& machine_;
    const profile::FdmSetup& setup_;
    const std::function<void(const Move&)>& sink_;
    Move move_;
    double layer_z_mm_ = 0;
    bool started_ = false;
    bool retracted_ = false;
};

}  // namespace

double filament_per_mm(const path::Bead& bead, const profile::FdmSetup& setup) {
    const double radius_mm = setup.machine.nozzle.filament_diameter_mm / 2;
    return path::bead_area_mm2(bead.width_mm, bead.height_mm) *
           setup.material.extrusion_multiplier / (std::numbers::pi * radius_mm * radius_mm);
}

double bead_speed_mm_per_s(const path::Bead& bead, const profile::FdmSetup& setup) {
    const double max_flow =
        std::min(setup.machine.nozzle.max_flow_mm3_per_s, setup.material.max_flow_mm3_per_s);
    const double area_mm2 =
        path::bead_area_mm2(bead.width_mm, bead.height_mm) * setup.material.extrusion_multiplier;
    return area_mm2 > 0 ? std::min(bead.speed.mm_per_s(), max_flow / area_mm2)
                        : bead.speed.mm_per_s();
}

void trace(const path::LayerStack& stack, const profile::FdmSetup& setup,
           const std::function<void(const Move&)>& sink) {
    Tracer tracer(setup, sink);
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
        tracer.print(stack.layers[i], i);
    }
    tracer.retract();
}

}  // namespace cam::motion
