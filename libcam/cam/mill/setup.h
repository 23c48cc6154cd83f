// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/mill/task.h"
#include "cam/path/mill_program.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/part.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace cam::mill {

/// One set-up, ready to be planned: everything in its own frame.
struct Bench {
    path::MillProgram program;     ///< without moves
    decomp::mesh::TriMesh target;  ///< the part and all that is kept: nothing cuts into it
    double floor_z = 0;            ///< the paths go no lower, dowel holes excepted
    Eigen::AlignedBox2d room;      ///< what is cleared: the whole stock, or what its border leaves
    bool open = true;              ///< the room's sides are free: a tool may come from outside
};

/// How a part is clamped, once or twice.
struct Clamping {
    std::vector<Bench> benches;
    std::vector<path::MillKeep> keeps;
    std::vector<path::MillDowel> dowels;  ///< to be drilled in the first set-up
    std::string flip_axis;                ///< "x", "y", or "" for one set-up
    double unseen_percent = 0;            ///< of the part's area, by no set-up
    std::vector<std::string> warnings;
};

/// Chooses the directions and the stock, and places both.
///
/// One set-up: a flat face lies on the table, held by it (tape, glue, vacuum); the whole stock
/// around the part is cleared. It is chosen when at most 1 % of the area is then out of sight.
///
/// Two set-ups: the stock keeps a border, in it two dowel holes on the line about which it is
/// turned over; tabs from the border hold the part at the middle of its outline, never on cut
/// faces. Each side is milled down to where the other's begins, and a little further.
///
/// The zero of each program is the corner of the stock at the least X and Y, on top.
/// @error mill.stock_too_small  the block does not hold the part and what is needed around it
/// @error mill.nothing_flat     one set-up was asked for and the part has no flat face to lie on
/// @error mill.no_cutter        no tool that can finish
/// and those of check_mill3().
[[nodiscard]] decomp::Result<Clamping> clamp_part(const decomp::part::Part& part,
                                                  const MillTask& task, decomp::Run& run);

}  // namespace cam::mill
