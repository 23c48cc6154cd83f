// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/limits.h"
#include "cam/verify/machine.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cam::verify {
namespace {

constexpr double kStandstillMm = 0.002;
constexpr double kLeastRadiusMm = 1e-6;
constexpr double kFullTurnSlack = 1e-9;    ///< radians: an arc back to its start is a full turn
constexpr double kLeastFilamentMm = 1e-9;  ///< rounding of sums is no deposit

}  // namespace

double Machine::end_of(const GcodeLine& line, std::size_t axis, bool& given) {
    const Word* word = line.find("XYZ"[axis]);
    const Axis& state = axes_[axis];
    given = word != nullptr;
    if (word == nullptr) {
        return state.position;
    }
    if (!word->has_value) {
        sight("proof.bad_number", quoted(text_) + " names an axis without a number");
        given = false;
        return state.position;
    }
    const double value = word->value * unit_mm_;
    return absolute_ ? value + state.offset : state.position + value;
}

double Machine::filament_of(const GcodeLine& line) {
    const Word* word = line.find('E');
    if (word == nullptr) {
        word = sailfish_ ? line.find(tool_ == 1 ? 'B' : 'A') : nullptr;
    }
    if (word == nullptr) {
        return 0;
    }
    if (!word->has_value) {
        sight("proof.bad_number", quoted(text_) + " names an axis without a number");
        return 0;
    }
    const double value = word->value * unit_mm_;
    const double step = e_absolute_ ? value - e_ : value;
    e_ += step;
    return step * flow_scale_;
}

void Machine::linear(const GcodeLine& line) {
    if (const Word* feed = line.find('F'); feed != nullptr && feed->has_value && feed->value > 0) {
        feed_mm_per_s_ = feed->value * unit_mm_ / 60;
    }
    std::array<double, 3> to{};
    std::array<bool, 3> given{};
    for (std::size_t a = 0; a < 3; ++a) {
        to[a] = end_of(line, a, given[a]);
    }
    go(to, given, filament_of(line));
}

void Machine::arc(const GcodeLine& line, bool clockwise) {
    if (const Word* feed = line.find('F'); feed != nullptr && feed->has_value && feed->value > 0) {
        feed_mm_per_s_ = feed->value * unit_mm_ / 60;
    }
    std::array<double, 3> to{};
    std::array<bool, 3> given{};
    for (std::size_t a = 0; a < 3; ++a) {
        to[a] = end_of(line, a, given[a]);
    }
    const double filament = filament_of(line);
    const std::array<double, 3> from = {axes_[0].position, axes_[1].position, axes_[2].position};
    Eigen::Vector2d start(from[0], from[1]);
    Eigen::Vector2d end(to[0], to[1]);
    Eigen::Vector2d centre =
        start + Eigen::Vector2d(line.value('I', 0), line.value('J', 0)) * unit_mm_;
    if (const Word* word = line.find('R'); word != nullptr && word->has_value) {
        const Eigen::Vector2d chord = end - start;
        const double radius = word->value * unit_mm_;
        const double half = chord.norm() / 2;
        const double rise = std::sqrt(std::max(0.0, radius * radius - half * half));
        const Eigen::Vector2d side = Eigen::Vector2d(-chord.y(), chord.x()).normalized();
        centre = start + chord / 2 + side * rise * (clockwise == (radius > 0) ? -1 : 1);
    }
    const double radius = (start - centre).norm();
    if (!(radius > kLeastRadiusMm) || !axes_[0].known || !axes_[1].known ||
        std::abs((end - centre).norm() - radius) > 0.5) {
        sight("proof.bad_arc", quoted(text_) + " is no arc from where the nozzle is");
        go(to, given, filament);
        return;
    }
    const double first = std::atan2(start.y() - centre.y(), start.x() - centre.x());
    double sweep = std::atan2(end.y() - centre.y(), end.x() - centre.x()) - first;
    const double turn = 2 * std::numbers::pi;
    sweep = clockwise ? (sweep >= -kFullTurnSlack ? sweep - turn : sweep)
                      : (sweep <= kFullTurnSlack ? sweep + turn : sweep);
    // Chords that leave the arc by 0.02 mm at most.
    const double step = 2 * std::acos(std::max(0.0, 1 - 0.02 / std::max(radius, 0.04)));
    const int steps = static_cast<int>(std::clamp(std::ceil(std::abs(sweep) / step), 1.0, 3600.0));
    for (int k = 1; k <= steps; ++k) {
        const double t = static_cast<double>(k) / steps;
        std::array<double, 3> point = to;
        if (k < steps) {
            point = {centre.x() + radius * std::cos(first + t * sweep),
                     centre.y() + radius * std::sin(first + t * sweep),
                     from[2] + t * (to[2] - from[2])};
        }
        go(point, {true, true, given[2]}, filament / steps);
    }
}

void Machine::go(const std::array<double, 3>& to, const std::array<bool, 3>& given,
                 double filament) {
    const Eigen::Vector3d from(axes_[0].position, axes_[1].position, axes_[2].position);
    bool was_known = true;
    for (const Axis& axis : axes_) {
        was_known = was_known && axis.known;
    }
    for (std::size_t a = 0; a < 3; ++a) {
        Axis& axis = axes_[a];
        if (given[a]) {
            if (a == 2 && (!axis.known || to[a] != axis.position)) {
                out_.climbs.push_back(
                    {static_cast<float>(to[a]), static_cast<std::int32_t>(line_)});
            }
            axis.position = to[a];
            axis.known = axis.known || absolute_;
        }
    }
    const Eigen::Vector3d end(axes_[0].position, axes_[1].position, axes_[2].position);
    if (filament != 0) {
        deposit(from, end, filament, was_known);
    }
    check_bounds(given);
    const bool trusted = axes_[0].trusted && axes_[1].trusted && axes_[2].trusted;
    const bool known = axes_[0].known && axes_[1].known && axes_[2].known;
    if (trusted && known && (given[0] || given[1] || given[2])) {
        const double depth = heights_.depth(was_known ? from : end, end);
        if (depth > limits::kBelowSlackMm &&
            !(was_known && heights_.depth(from, from) > limits::kBelowSlackMm &&
              end.z() > from.z())) {
            ++out_.moves_below_printed;
            sight("proof.below_printed", "the nozzle goes " + figure(depth) +
                                             " mm below material that is printed already, " +
                                             figure(limits::kBelowSlackMm) + " mm is allowed");
            if (was_known && !out_.sightings.empty() && out_.sightings.back().line == line_) {
                out_.sightings.back().z = std::max(from.z(), end.z());  // the layer it dives from
            }
        }
    }
}

void Machine::check_bounds(const std::array<bool, 3>& given) {
    const auto& chamber = setup_.machine.chamber;
    for (std::size_t a = 0; a < 3; ++a) {
        const Axis& axis = axes_[a];
        if (!given[a] || !axis.known || !axis.trusted) {
            continue;
        }
        const auto index = static_cast<Eigen::Index>(a);
        const double low = chamber.min_mm[index];
        const double high = chamber.max_mm[index];
        if (axis.position < low - limits::kChamberSlackMm ||
            axis.position > high + limits::kChamberSlackMm) {
            ++out_.moves_outside_chamber;
            sight("proof.outside_chamber", std::string("a move to ") + "XYZ"[a] +
                                               figure(axis.position, 3) + ", the chamber is " +
                                               figure(low, 3) + " .. " + figure(high, 3) + " mm");
            return;
        }
    }
}

void Machine::deposit(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double filament,
                      bool was_known) {
    Tool& tool = tools_[tool_];
    tool.fed += filament;
    const double pushed = tool.fed - tool.high_water;
    if (pushed <= kLeastFilamentMm) {
        return;
    }
    tool.high_water = tool.fed;
    const double volume = pushed * filament_area_;
    out_.filament_mm += pushed;
    out_.extruded_mm3 += volume;
    check_heat();
    const double run_mm = (to - from).head<2>().norm();
    if (!was_known && run_mm > kStandstillMm) {
        sight("proof.unknown_position",
              "filament is pushed on a move that starts nobody knows where", false);
        return;
    }
    if (run_mm <= kStandstillMm) {
        if (out_.beads.empty()) {
            out_.prime_mm3 += volume;
            return;
        }
        out_.blob_mm3 += volume;
        if (volume > limits::kBlobMm3) {
            sight("proof.blob", figure(volume) + " mm^3 (" + figure(pushed) +
                                    " mm of filament) is pushed at a standstill, " +
                                    figure(limits::kBlobMm3) + " mm^3 is allowed");
        }
        return;
    }
    for (Axis& axis : axes_) {
        axis.trusted = true;
    }
    check_flow(from, to, volume);
    if (!near_chamber(from) || !near_chamber(to)) {
        return;  // reported by check_bounds
    }
    heights_.raise(from, to);
    out_.beads.push_back({static_cast<float>(from.x()), static_cast<float>(from.y()),
                          static_cast<float>(to.x()), static_cast<float>(to.y()),
                          static_cast<float>(to.z()), static_cast<float>(volume * intended_),
                          static_cast<std::int32_t>(line_), declared_ ? role_ : Role::Adhesion,
                          outer_wall_});
}

bool Machine::near_chamber(const Eigen::Vector3d& point) const {
    constexpr double kNearMm = 10;
    const auto& chamber = setup_.machine.chamber;
    return ((point - chamber.min_mm).array() >= -kNearMm).all() &&
           ((point - chamber.max_mm).array() <= kNearMm).all();
}

void Machine::check_heat() {
    const Tool& tool = tools_[tool_];
    const double least = setup_.material.nozzle_celsius - limits::kNozzleSlackCelsius;
    if (cold_told_ || (tool.target >= least && tool.heated)) {
        return;
    }
    cold_told_ = true;
    if (tool.target < least) {
        sight("proof.cold_extrusion", "filament is pushed while the nozzle is set to " +
                                          figure(tool.target, 1) + " C, " + setup_.material.name +
                                          " needs " + figure(least, 1) + " C");
    } else {
        sight("proof.cold_extrusion",
              "filament is pushed before the program has waited for the nozzle to reach " +
                  figure(tool.target, 1) + " C");
    }
}

void Machine::check_flow(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double volume) {
    const Eigen::Vector3d step = (to - from).cwiseAbs();
    double seconds = feed_mm_per_s_ > 0 ? step.norm() / (feed_mm_per_s_ * feed_scale_) : 0;
    for (int a = 0; a < 3; ++a) {
        const double fastest = setup_.machine.motion.max_speed_mm_per_s[a];
        seconds = fastest > 0 ? std::max(seconds, step[a] / fastest) : seconds;
    }
    if (seconds <= 0) {
        return;
    }
    const double flow = volume / seconds;
    // Shorter than a tenth of a millimetre the printed decimals of E decide the figure.
    if (step.norm() < 0.1) {
        return;
    }
    out_.max_flow_mm3_per_s = std::max(out_.max_flow_mm3_per_s, flow);
    if (flow <= flow_limit_ * limits::kFlowSlack) {
        return;
    }
    if (rush_ && rush_->z != to.z()) {
        end_rush();
    }
    if (!rush_) {
        rush_ = Rush{line_, to.z(), 0, 0};
    }
    rush_->flow = std::max(rush_->flow, flow);
    rush_->length += step.norm();
}

void Machine::end_rush() {
    if (rush_) {
        out_.sightings.push_back({"proof.flow", rush_->line, rush_->z,
                                  "up to " + figure(rush_->flow) + " mm^3/s on " +
                                      figure(rush_->length, 1) + " mm of path, the limit is " +
                                      figure(flow_limit_) + " mm^3/s"});
        rush_.reset();
    }
}

}  // namespace cam::verify
