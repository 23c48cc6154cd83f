// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/units.h"

namespace cam::path {

/// How a tool cuts in one material on one machine: already clamped by the machine's spindle and
/// axes.
struct CutValues {
    double spindle_rpm = 0;
    decomp::Speed feed;       ///< along the path, in the material
    decomp::Speed ramp;       ///< down a ramp or a helix
    decomp::Speed plunge;     ///< straight down
    double step_down_mm = 0;  ///< depth of one level at most
    double step_over_mm = 0;  ///< between neighbouring paths at most
};

/// What a planner asks of a table of feeds, tool by tool. A tool that is no good for something (a
/// drill for roughing) has a feed of 0 there.
struct ToolFeeds {
    CutValues rough;   ///< beside what is cut already, at most step_over deep into the material
    CutValues slot;    ///< with the tool's whole width in the material
    CutValues finish;  ///< what roughing left; its step_over is the planner's choice
    CutValues drill;   ///< plunge is the feed, step_down the peck
};

}  // namespace cam::path
