// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/millproof/prove.h"

#include <string_view>
#include <vector>

namespace cam::millproof {

/// A straight piece of the tip's way, with everything that holds while it is gone.
struct Step {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    long line = 0;
    int tool = -1;  ///< index in MillJob::tools; -1: none known
    bool rapid = false;
    double mm_per_min = 0;
};

struct ProgramPath {
    std::vector<Step> steps;
    std::vector<Fault> faults;
    std::vector<long> tool_lines;  ///< where each change of tool stands
};

/// Reads the text of a program: words, modes, arcs (as chords within 0.001 mm). Faults: words that
/// cannot be read or that the dialect forbids, inches, incremental or inverse-time modes, arcs that
/// are none, cuts without spindle, feed or tool, feeds and speeds beyond the machine, the tool or
/// the material, tools that nobody has, programs without an end. Never throws. O(bytes).
[[nodiscard]] ProgramPath read_program(std::string_view program, const MillJob& job);

}  // namespace cam::millproof
