// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/mill3.h"
#include "cam/profile/read_mill.h"
#include "cam/profile/read_profile.h"
#include "cam/tool/tool.h"
#include "decomp/part/judge.h"

#include <Eigen/Core>

#include <vector>

/// Judges made of the checks: what a search over decompositions asks. Pure, callable from several
/// threads; constraint names stand in docs/checks.md.
namespace cam::check {

/// What of a part's box does not fit a mill: "travel.x", "travel.y", "travel.z" (the cutter must
/// pass beside the part, so its diameter counts in X and Y), "spindle" (part and tool together
/// under the spindle's nose).
[[nodiscard]] std::vector<decomp::part::Violation> mill_misfits(
    const profile::MillMachine& machine, const std::vector<tool::Tool>& tools,
    const Eigen::Vector3d& size_mm);

/// The same about the rotary axis: "rotary.diameter", "rotary.length", "spindle"; "rotary" when the
/// machine has none.
[[nodiscard]] std::vector<decomp::part::Violation> rotary_misfits(
    const profile::MillMachine& machine, const std::vector<tool::Tool>& tools, double radius_mm,
    double length_mm);

/// orient::fdm_judge() that also wants little support: "support" when its area is more than
/// `max_support_percent` of the part's.
[[nodiscard]] decomp::part::Judge support_judge(const profile::FdmSetup& setup,
                                                double max_support_percent);

/// Three axes: misfits, "base" (with one set-up: no flat face to lie on), "reach" (more than
/// reach.max_unreached_percent is reached by none of the tools; an Estimate asks rays).
/// Cuts that help go across the spindle where the undercut begins.
[[nodiscard]] decomp::part::Judge mill3_judge(const profile::MillSetup& setup, Setups setups);

/// A rotary axis, searched: misfits and "reach"; an Estimate searches coarsely and asks rays, an
/// Exact verdict the tools. Cuts that help go across the axis through what is not reached.
[[nodiscard]] decomp::part::Judge mill4_judge(const profile::MillSetup& setup);

}  // namespace cam::check
