// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/planner.h"

#include <algorithm>
#include <cmath>

namespace cam::sim {

void Planner::add(const Point& target, double mm_per_s, double seconds, Time now) {
    double square = 0;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
        square += (target[axis] - last_[axis]) * (target[axis] - last_[axis]);
    }
    const double length = std::sqrt(square);
    if (length > 0) {
        const double speed = std::clamp(mm_per_s, 0.01, options_.max_mm_per_s);
        const double ramp = speed * speed / options_.acceleration_mm_per_s2;
        // Rest to rest: a trapezoid, or a triangle when the move is too short for the speed.
        seconds += length > ramp ? length / speed + speed / options_.acceleration_mm_per_s2
                                 : 2 * std::sqrt(length / options_.acceleration_mm_per_s2);
    }
    if (options_.instant) {
        last_ = target;
        return;
    }
    const Time begin = blocks_.empty() ? now : std::max(now, blocks_.back().end);
    const Time duration(static_cast<Time::rep>(seconds / options_.speed * 1e9));
    blocks_.push_back({last_, target, begin, begin + duration});
    last_ = target;
}

void Planner::advance(Time now) {
    while (!held_ && !blocks_.empty() && blocks_.front().end <= now) {
        blocks_.pop_front();
    }
}

Point Planner::position(Time now) const {
    if (blocks_.empty()) {
        return last_;
    }
    const Block& block = blocks_.front();
    const Time at = held_ ? held_since_ : now;
    const double whole = static_cast<double>((block.end - block.begin).count());
    const double done = static_cast<double>((at - block.begin).count());
    const double fraction = whole > 0 ? std::clamp(done / whole, 0.0, 1.0) : 1.0;
    Point point{};
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
        point[axis] = block.from[axis] + fraction * (block.to[axis] - block.from[axis]);
    }
    return point;
}

void Planner::hold(Time now) {
    if (!held_) {
        held_ = true;
        held_since_ = now;
    }
}

void Planner::release(Time now) {
    if (!held_) {
        return;
    }
    held_ = false;
    for (Block& block : blocks_) {
        block.begin += now - held_since_;
        block.end += now - held_since_;
    }
}

void Planner::drop(Time now) {
    last_ = position(now);
    blocks_.clear();
    held_ = false;
}

}  // namespace cam::sim
