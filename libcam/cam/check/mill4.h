// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/axis_search.h"
#include "cam/check/cover.h"
#include "cam/check/reach.h"
#include "cam/check/rotary.h"
#include "cam/check/share.h"
#include "cam/tool/tool.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/part/part.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace cam::check {

struct Mill4Options {
    std::optional<Eigen::Vector3d> axis;  ///< any length; none: searched
    int angles = 40;                      ///< at most visibility::kMostDirections
    int a_sign = 1;                       ///< see docs/frames.md
    double good_cosine = 0.17;  ///< a position is preferred for facets that face it by 10 degrees
    bool find_indices = true;   ///< the smallest set of A; costs a ray for each facet and angle
    CoverOptions cover;
    AxisOptions search;
    ReachOptions reach;
};

/// Positions of A at which all of what can be reached is, up to the cover's share. A facet that
/// some position shows by more than good_cosine wants one of those.
struct Indices {
    std::vector<double> a_degrees;        ///< the one that adds most first
    std::vector<double> covered_percent;  ///< of the part's area, after each of them
    double coverable_percent = 0;         ///< with all angles
    bool smallest = false;                ///< proved: no smaller set does it
    int at_least = 0;                     ///< proved: no set of fewer does it
};

/// What one tool does about the chosen axis.
struct RotaryToolFigures {
    std::string tool;
    Share unreached_cutter;      ///< from no angle, by the cutting part alone; ends excluded
    Share unreached;             ///< with shank and holder
    Share unreached_at_indices;  ///< at the indices that were found for rays
    Indices indices;             ///< its own
};

/// How a facet ends up, for pictures.
struct Mill4Facets {
    std::vector<char> end;         ///< excluded
    std::vector<char> hidden_end;  ///< of them, those counted by `ends_unseen`
    std::vector<char> seen;        ///< by a ray, from some angle
    std::vector<int> index;        ///< which of `indices` sees it first; -1: none
    std::vector<char> reached;     ///< most of it by the first tool, from some angle; or empty
};

/// A part about one rotary axis. `unseen.by_facets_percent` is %4AM of the paper (7.3: ends not
/// counted), `unseen.by_area_percent` the same by area.
struct Mill4Check {
    std::vector<AxisChoice> axes;  ///< the chosen one first; others only when searched
    Cylinder stock;
    decomp::Pose<decomp::SetupFrame, decomp::ModelFrame> setup_from_model;
    Share unseen;       ///< from no angle; ends excluded
    Share ends;         ///< excluded: |normal . axis| > kEndCosine
    Share ends_unseen;  ///< of the ends, those that no direction across the axis sees, not even
                        ///< along their own plane: what a tool's flank cannot reach either
    Share unseen_with_ends;  ///< if an end counted like any other facet
    Share uncertain;  ///< of the unseen, those that a ray with another start would see: rounding
    Indices indices;
    std::vector<RotaryToolFigures> tools;
    Share unreached_together;  ///< by none of the tools; without tools by no ray
    Mill4Facets facets;
};

/// The paper's section 7.3 with the axis found, not asked for: which facets no position of A shows
/// to the tool, the smallest set of positions that shows all others, and what real tools reach.
/// @error check.axis (no direction), visibility.device, check.raster_too_large, run.cancelled
/// Cost: with the axis given and without indices and tools about 0.3 rays a facet and the rays'
/// tree; see tests/bench for figures.
[[nodiscard]] decomp::Result<Mill4Check> check_mill4(const decomp::part::Part& part,
                                                     const Mill4Options& options,
                                                     const std::vector<tool::Tool>& tools,
                                                     const decomp::Run& run);

}  // namespace cam::check
