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
                travel(bead, layer.z_mm);
                extrude(bead);
            }
        }
        if (layer.pause_s > 0) {
            pause(layer.pause_s);
        }
    }

    void retract() {
        if (retracted_ || machine_.retraction.length_mm <= 0) {
            return;
        }
        retracted_ = true;
        const double left_mm = machine_.retraction.length_mm - wipe();
        if (left_mm > kLeastRetractionMm) {
            emit(MoveKind::Retract, -left_mm, machine_.retraction.speed.mm_per_s());
        }
    }

  private:
    static constexpr double kPauseLiftMm = 2;
    static constexpr double kLeastRetractionMm = 1e-9;

    /// Retracts along the way back over the last bead; returns the filament pulled back.
    double wipe() {
        const auto& rules = machine_.retraction;
        if (rules.wipe_mm <= 0 || last_ == nullptr) {
            return 0;
        }
        const path::Bead& bead = *last_;
        last_ = nullptr;
        double left_mm = rules.wipe_mm;
        double pulled_mm = 0;
        for (std::size_t i = bead.points.size() - 1; i-- > 0 && left_mm > 0;) {
            const Eigen::Vector2d way = bead.points[i] - move_.to.head<2>();
            const double length_mm = way.norm();
            const double share = length_mm > left_mm ? left_mm / length_mm : 1.0;
            if (length_mm <= 0) {
                continue;
            }
            const double filament_mm = rules.length_mm * share * length_mm / rules.wipe_mm;
            move_.to.head<2>() += share * way;
            left_mm -= share * length_mm;
            pulled_mm += filament_mm;
            emit(MoveKind::Wipe, -filament_mm,
                 rules.speed.mm_per_s() * rules.wipe_mm / rules.length_mm);
        }
        return pulled_mm;
    }

    /// Waits above the part, so that the nozzle neither oozes onto it nor keeps it hot.
    void pause(double seconds) {
        retract();
        lift_to(MoveKind::Raise, std::min(layer_z_mm_ + kPauseLiftMm,
                                          std::max(machine_.chamber.max_mm.z(), layer_z_mm_)));
        move_.seconds = seconds;
        emit(MoveKind::Pause, 0, 0);
        move_.seconds = 0;
    }

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

    [[nodiscard]] double way_mm(const path::Bead& bead) const {
        double sum = 0;
        Eigen::Vector2d at = move_.to.head<2>();
        for (const Eigen::Vector2d& p : bead.approach.by) {
            sum += (p - at).norm();
            at = p;
        }
        return sum + (bead.points.front() - at).norm();
    }

    void go(const Eigen::Vector2d& target) {
        if (target != move_.to.head<2>() || !started_) {
            move_.to.head<2>() = target;
            emit(MoveKind::Travel, 0, machine_.process.travel_speed.mm_per_s());
        }
    }

    /// To the beginning of a bead. Between layers the way is straight: it begins elsewhere.
    void travel(const path::Bead& bead, double z_mm) {
        const Eigen::Vector2d& target = bead.points.front();
        const double distance_mm = way_mm(bead);
        const bool same_height = started_ && z_mm == layer_z_mm_;
        if (same_height && distance_mm == 0) {
            return;
        }
        const bool inside = same_height && bead.approach.inside;
        const profile::FdmMachine::Retraction& rules = machine_.retraction;
        if (!same_height || distance_mm >= (inside ? rules.max_inside_mm : rules.min_travel_mm)) {
            retract();
            const double lift_mm = started_ && !inside ? rules.lift_mm : 0.0;
            const double above_mm = std::min(std::max(z_mm, layer_z_mm_) + lift_mm,
                                             std::max(machine_.chamber.max_mm.z(), z_mm));
            lift_to(MoveKind::Raise, std::max(above_mm, move_.to.z()));
        }
        if (same_height) {
            for (const Eigen::Vector2d& p : bead.approach.by) {
                go(p);
            }
        }
        go(target);
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
        last_ = &bead;
    }

    const profile::FdmMachine& machine_;
    const profile::FdmSetup& setup_;
    const std::function<void(const Move&)>& sink_;
    Move move_;
    const path::Bead* last_ = nullptr;  ///< along which to wipe
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
