// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/mill_program.h"
#include "cam/tool/tool.h"
#include "decomp/base/units.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace cam::mill {

/// A tool and how it cuts in the material at hand.
struct Cutter {
    tool::Tool tool;
    path::ToolFeeds feeds;
};

enum class Setups { Auto, One, Two };
enum class Flip { Auto, AboutX, AboutY };

/// What is asked of the planner, besides the part.
struct MillTask {
    std::vector<Cutter> cutters;  ///< in the order of use: the first clears, the last finishes
    Setups setups = Setups::Auto;
    Flip flip = Flip::Auto;
    std::optional<Eigen::Vector3d> stock_mm;  ///< block at hand; none: what the part needs
    double allowance_mm = 0.3;                ///< that roughing leaves
    double scallop_mm = 0.01;                 ///< between the lines of finishing, at most
    decomp::Angle lines;                      ///< of parallel finishing, from the program's X
    decomp::Angle steep = decomp::Angle::degrees(55);  ///< faces beyond it get levels, not lines
    double cell_mm = 0.2;                              ///< of the height maps of roughing
    double safe_mm = 10;                               ///< above the stock
    double shank_clearance_mm = 0.2;
    double holder_clearance_mm = 1;
};

/// Distance of a finishing tool's lines that leaves scallops of this height on level ground: by
/// the radius of its tip; a third of the diameter for a flat end.
[[nodiscard]] double stepover_mm(const tool::Tool& tool, double scallop_mm);

}  // namespace cam::mill
