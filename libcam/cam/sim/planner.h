// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/board.h"

#include <array>
#include <cstddef>
#include <deque>

namespace cam::sim {

inline constexpr std::size_t kAxes = 6;
using Point = std::array<double, kAxes>;

/// A queue of straight moves that run one after the other, each from rest to rest.
class Planner {
  public:
    explicit Planner(const BoardOptions& options) : options_(options) {}

    [[nodiscard]] bool full() const {
        return blocks_.size() >= static_cast<std::size_t>(options_.planner_blocks);
    }

    [[nodiscard]] bool empty() const { return blocks_.empty(); }

    [[nodiscard]] int free() const {
        return options_.planner_blocks - static_cast<int>(blocks_.size());
    }

    /// A move to `target` at this speed, or a pause of `seconds` when the target is where we are.
    void add(const Point& target, double mm_per_s, double seconds, Time now);

    /// Forgets what has ended.
    void advance(Time now);

    /// When the oldest block ends; only unless empty().
    [[nodiscard]] Time first_end() const { return blocks_.front().end; }

    /// Where the machine stands, between the ends of a block too.
    [[nodiscard]] Point position(Time now) const;

    /// Feed hold: time stands still for all blocks.
    void hold(Time now);
    void release(Time now);

    [[nodiscard]] bool held() const { return held_; }

    /// Drops all blocks; the machine stands where it is.
    void drop(Time now);

    /// Says where the machine is.
    void place(const Point& point) { last_ = point; }

    /// Where the last block ends.
    [[nodiscard]] const Point& target() const { return last_; }

  private:
    struct Block {
        Point from{};
        Point to{};
        Time begin{};
        Time end{};
    };

    const BoardOptions& options_;
    std::deque<Block> blocks_;
    Point last_{};
    bool held_ = false;
    Time held_since_{};
};

}  // namespace cam::sim
