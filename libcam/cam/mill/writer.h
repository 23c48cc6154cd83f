// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/mill/task.h"
#include "cam/path/mill_program.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace cam::mill {

/// The points that are needed so that no point left out is further than `tolerance_mm` from the
/// line (Douglas-Peucker in space).
[[nodiscard]] std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points,
                                                   double tolerance_mm);

/// Writes the moves of a program and keeps its promises: across only at the safe height, no cut
/// without a turning spindle, an end at the safe height with the spindle off.
class Writer {
  public:
    explicit Writer(path::MillProgram& program) : program_(&program) {}

    /// Takes the tool if it is another one and sets the spindle.
    void take(const Cutter& cutter, double rpm, path::MillOperation operation);

    /// Up, across, and down to `clear_z` without cutting; then straight down to the point at a
    /// feed. Nothing may be in the way above clear_z.
    void approach(const Eigen::Vector3d& to, double clear_z, decomp::Speed plunge);

    void cut(const Eigen::Vector3d& to, decomp::Speed feed);
    void cut_along(const std::vector<Eigen::Vector3d>& points, decomp::Speed feed);
    void retract();
    void finish();

    /// Where the tip is; nothing before the first approach and after a retract only in Z unknown.
    [[nodiscard]] const std::optional<Eigen::Vector3d>& at() const { return at_; }

    /// Whether the tip is down at work.
    [[nodiscard]] bool is_down() const { return at_ && at_->z() < program_->safe_z; }

  private:
    template <class What>
    void add(const What& what) {
        program_->moves.push_back({operation_, what});
    }

    path::MillProgram* program_;
    path::MillOperation operation_ = path::MillOperation::Rough;
    std::optional<Eigen::Vector3d> at_;
    int tool_ = 0;
    double rpm_ = 0;
};

}  // namespace cam::mill
