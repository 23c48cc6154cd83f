// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/mill_feeds.h"
#include "cam/profile/mill_machine.h"
#include "cam/tool/tool.h"

#include <string>
#include <vector>

/// Feeds and speeds: what a tool may do in a material on a machine.
namespace cam::feeds {

/// By how much a tooth's feed may grow so that the thickest chip keeps its thickness when only
/// `width_mm` of the diameter engages: D / (2 sqrt(D w - w^2)) below half the diameter, else 1.
[[nodiscard]] double chip_thinning(double diameter_mm, double width_mm);

/// Diameter at which a tool cuts at a height above its tip: that of a ball's circle, of a cone, or
/// the whole.
[[nodiscard]] double effective_diameter_mm(const tool::Tool& tool, double depth_mm);

/// What the spindle must give for a cut: the material's power for each mm^3/s of chips, over a
/// drive that passes 0.8 of it on.
[[nodiscard]] double power_w(const profile::MillMaterial& material, double step_down_mm,
                             double step_over_mm, decomp::Speed feed);

struct Feeds {
    path::ToolFeeds values;
    double rough_power_w = 0;        ///< of the heavier of rough and slot
    std::vector<std::string> notes;  ///< what was clamped and why, a sentence each
};

/// Values for one tool: speed from the material's surface speed, feed from its chip load (thinned
/// chips allowed for), clamped to the machine's axes and spindle; where the feed is clamped the
/// spindle slows down until chips are thick enough again; depth is taken back until the spindle's
/// power suffices, where it is known. Drills and V tools rough and slot at a feed of 0: not at all.
[[nodiscard]] Feeds feeds_for(const tool::Tool& tool, const profile::MillMaterial& material,
                              const profile::MillMachine& machine);

}  // namespace cam::feeds
