// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/mill_program.h"
#include "cam/profile/read_mill.h"
#include "decomp/base/result.h"

#include <string>
#include <vector>

namespace cam::post {

/// Arcs that a dialect does not write become lines that leave them by at most this.
inline constexpr double kMillChordMm = 0.002;

/// Writes one set-up's program: the dialect's start, tools, moves, and its end. Coordinates are
/// rounded once, on the grid of the dialect's last decimal; axes that do not move are left out,
/// feeds are written when they change. A rapid that rises goes up before it goes across, one that
/// sinks goes across first. Arcs are written in halves of at most 180 degrees, centres relative,
/// where the dialect has arcs and the radius is within its bounds; else as lines. Serial, O(moves).
/// @error post.mill_order (a cut before a tool or without the spindle, a move other than a rapid
/// after a change of tool, a number that is none), post.mill_tool (no such tool), post.mill_feed (a
/// feed of 0 or less), post.long_line, post.forbidden_word, profile.template_name,
/// profile.template_syntax
[[nodiscard]] decomp::Result<std::string> post_mill(const path::MillProgram& program,
                                                    const std::vector<tool::Tool>& tools,
                                                    const profile::MillSetup& setup,
                                                    const std::string& title);

}  // namespace cam::post
