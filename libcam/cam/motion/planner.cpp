// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/motion/planner.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cam::motion {

namespace {

/// Seconds over a length, entered and left at given speeds, at most at `top`.
double trapezoid_seconds(double length, double entry, double exit, double top,
                         double acceleration) {
    const double to_top = (top * top - entry * entry) / (2 * acceleration);
    const double from_top = (top * top - exit * exit) / (2 * acceleration);
    if (to_top + from_top <= length) {
        return (top - entry) / acceleration + (top - exit) / acceleration +
               (length - to_top - from_top) / top;
    }
    // Too short to reach the top speed: a triangle.
    const double peak =
        std::sqrt(std::max(acceleration * length + (entry * entry + exit * exit) / 2,
                           std::max(entry * entry, exit * exit)));
    return (peak - entry) / acceleration + (peak - exit) / acceleration;
}

}  // namespace

double Planner::junction_speed(const Eigen::Vector4d& before, const Eigen::Vector4d& after) const {
    double speed = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 4; ++axis) {
        const double step = std::abs(after[axis] - before[axis]);
        if (step > 0) {
            speed = std::min(speed, motion_.jerk_mm_per_s[axis] / step);
        }
    }
    return speed;
}

void Planner::add(const Segment& segment) {
    const double path_mm = segment.delta_mm.head<3>().norm();
    const double length = path_mm > 0 ? path_mm : std::abs(segment.delta_mm[3]);
    if (!(length > 0)) {
        return;
    }
    Block block{segment.delta_mm / length,      length, segment.speed_mm_per_s,
                segment.acceleration_mm_per_s2, 0,      segment.slot};
    for (int axis = 0; axis < 4; ++axis) {
        const double share = std::abs(block.direction[axis]);
        if (share > 0) {
            block.speed = std::min(block.speed, motion_.max_speed_mm_per_s[axis] / share);
            block.acceleration =
                std::min(block.acceleration, motion_.max_acceleration_mm_per_s2[axis] / share);
        }
    }
    block.entry_speed = block.speed;
    if (blocks_.empty()) {
        if (entered_at_ < 0) {
            block.entry_speed =
                std::min(block.speed, junction_speed(Eigen::Vector4d::Zero(), block.direction));
        }
    } else {
        const Block& last = blocks_.back();
        block.entry_speed =
            std::min({block.speed, last.speed, junction_speed(last.direction, block.direction)});
    }
    blocks_.push_back(block);
    if (blocks_.size() >= 2 * kLookAhead) {
        commit(kLookAhead);
    }
}

void Planner::plan() {
    const std::size_t count = blocks_.size();
    entry_.assign(count + 1, 0);
    const Block& last = blocks_.back();
    entry_[count] = std::min(last.speed, junction_speed(last.direction, Eigen::Vector4d::Zero()));
    for (std::size_t i = count; i-- > 0;) {
        const Block& block = blocks_[i];
        const double reach =
            std::sqrt(entry_[i + 1] * entry_[i + 1] + 2 * block.acceleration * block.length_mm);
        entry_[i] = std::min(block.entry_speed, reach);
    }
    if (entered_at_ >= 0) {
        entry_[0] = entered_at_;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Block& block = blocks_[i];
        const double reach =
            std::sqrt(entry_[i] * entry_[i] + 2 * block.acceleration * block.length_mm);
        entry_[i + 1] = std::min(entry_[i + 1], reach);
    }
}

void Planner::commit(std::size_t count) {
    plan();
    for (std::size_t i = 0; i < count; ++i) {
        const Block& block = blocks_[i];
        if (seconds_.size() <= block.slot) {
            seconds_.resize(block.slot + 1, 0.0);
        }
        seconds_[block.slot] += trapezoid_seconds(block.length_mm, entry_[i], entry_[i + 1],
                                                  block.speed, block.acceleration);
    }
    entered_at_ = entry_[count];
    blocks_.erase(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(count));
}

std::vector<double> Planner::finish() {
    if (!blocks_.empty()) {
        commit(blocks_.size());
    }
    entered_at_ = -1;
    return std::move(seconds_);
}

}  // namespace cam::motion
