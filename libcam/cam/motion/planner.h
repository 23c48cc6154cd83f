// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"

#include <Eigen/Core>

#include <cstddef>
#include <utility>
#include <vector>

namespace cam::motion {

/// A straight move of the axes X, Y, Z, E.
struct Segment {
    Eigen::Vector4d delta_mm = Eigen::Vector4d::Zero();
    double speed_mm_per_s =
        0;  ///< wished, along the path in X, Y, Z, or of E when nothing else moves
    double acceleration_mm_per_s2 = 0;
    std::size_t slot = 0;  ///< where its seconds are added
};

/// Times straight moves as a look-ahead planner drives them: constant acceleration, no axis above
/// its speed and acceleration, and at each junction a speed at which no axis steps by more than its
/// jerk. Standstill to motion and back is such a step too.
///
///      speed   ______
///             /      \___        the junction speed bounds both moves;
///            /           \       the backward pass makes room for braking,
///         __/             \__    the forward pass for accelerating
///           move 1   move 2
///
/// Sees `kLookAhead` moves at once, hence takes constant memory. Deterministic.
class Planner {
  public:
    explicit Planner(profile::FdmMachine::Motion motion) : motion_(std::move(motion)) {}

    /// Appends a move; those of no length are ignored.
    void add(const Segment& segment);

    /// Brings the machine to a standstill and returns the seconds of each slot.
    [[nodiscard]] std::vector<double> finish();

    static constexpr std::size_t kLookAhead = 1024;

  private:
    struct Block {
        Eigen::Vector4d direction;  ///< per mm of path
        double length_mm;
        double speed;
        double acceleration;
        double entry_speed;  ///< highest allowed at its beginning
        std::size_t slot;
    };

    void commit(std::size_t count);
    void plan();
    [[nodiscard]] double junction_speed(const Eigen::Vector4d& before,
                                        const Eigen::Vector4d& after) const;

    profile::FdmMachine::Motion motion_;
    std::vector<Block> blocks_;
    std::vector<double>
        entry_;  ///< planned entry speed of each block, and the exit speed of the last
    double entered_at_ =
        -1;  ///< speed at which the first block is entered; negative: from standstill
    std::vector<double> seconds_;
};

}  // namespace cam::motion
