// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/reach.h"
#include "cam/check/share.h"
#include "cam/tool/tool.h"
#include "cam/visibility/sight.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/part/part.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace cam::check {

enum class Setups { One, Two };

struct Mill3Options {
    Setups setups = Setups::One;
    ReachOptions reach;
};

/// One way to clamp a part: the spindle comes from `direction`, in a second set-up from the
/// opposite side. Flat parts of the base are excluded: they exist when milling begins.
struct Mill3Pose {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< from the part to the spindle
    int plane = -1;                                        ///< cut plane of the base, or -1
    bool flat_base = false;                                ///< the part lies on a flat face
    Share base;                                            ///< excluded
    Share undercut;             ///< faces away: the paper's %3AM, normals only
    Share unseen;               ///< faces away, or something lies above it; walls count as seen
    bool height_field = false;  ///< nothing leans over by more than a degree
};

/// What one tool does in the best pose.
struct ToolFigures {
    std::string tool;
    Share unreached_cutter;  ///< not by the cutting part alone
    Share unreached;         ///< not with shank and holder in the way: never less
};

/// How a facet ends up, for pictures; the base is excluded first.
struct Mill3Facets {
    std::vector<char> base;
    std::vector<char> seen;     ///< by a ray
    std::vector<char> reached;  ///< most of it by the first tool; empty without tools
};

struct Mill3Check {
    std::vector<Mill3Pose> poses;    ///< one for each flat face, or for the ends of the axes
    std::size_t best = 0;            ///< least unseen area
    std::size_t best_by_normal = 0;  ///< least undercut: %3AM of the paper
    std::vector<ToolFigures> tools;
    Share unreached_together;  ///< by none of the tools; without tools by no ray
    Mill3Facets facets;
};

/// The height-field test of the paper's section 7.2 and true accessibility. With one set-up the
/// part stands on a flat face (the ends of the model axes where there is none, and `flat_base`
/// says so) and no tool goes below it. With two it is milled from a direction and its opposite,
/// held at its sides: candidates are the flat faces, the model axes and the principal axes.
/// Ties: flat bases first, then the order of discovery.
/// @error visibility.device, check.raster_too_large, run.cancelled
/// Cost: one ray a facet and pose, and for each tool one tool_reach() a set-up.
[[nodiscard]] decomp::Result<Mill3Check> check_mill3(const decomp::part::Part& part,
                                                     const Mill3Options& options,
                                                     const std::vector<tool::Tool>& tools,
                                                     const decomp::Run& run);

}  // namespace cam::check
