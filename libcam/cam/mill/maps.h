// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/height_map.h"
#include "cam/mill/setup.h"
#include "cam/mill/task.h"
#include "cam/tool/tool.h"
#include "decomp/base/result.h"

#include <Eigen/Geometry>

#include <vector>

/// Height maps for roughing and for what lies in the way: never for the points of a finishing path.
namespace cam::mill {

/// Where the axis of a tool may be: the room less its radius, or with it, where sides are open.
[[nodiscard]] Eigen::AlignedBox2d axis_room(const Bench& bench, const tool::Tool& tool);

/// The target of a set-up and what is left of its stock.
struct StockMaps {
    check::HeightMap target;  ///< the part and what is kept
    check::HeightMap stock;   ///< what is there now; never below the target
};

/// Before anything is cut. @error check.raster_too_large
[[nodiscard]] decomp::Result<StockMaps> untouched(const Bench& bench, const MillTask& task);

/// How low the tool's tip may go at each node when it keeps `allowance_mm` from the target, and
/// shank and holder keep their clearances from all stock that the tool itself does not remove.
[[nodiscard]] check::HeightMap lowest_tips_over(const StockMaps& maps, const Bench& bench,
                                                const tool::Tool& tool, double allowance_mm,
                                                const MillTask& task);

/// How low the tip may go so that shank and holder stay clear of what is there now.
[[nodiscard]] check::HeightMap body_tips(const check::HeightMap& stock, const tool::Tool& tool,
                                         const MillTask& task);

/// How low the tip may go without touching what is there now.
[[nodiscard]] check::HeightMap air_tips(const check::HeightMap& stock, const tool::Tool& tool);

/// Takes from the stock what the tool removes with its tip at these heights.
void remove(check::HeightMap& stock, const check::HeightMap& tips, const tool::Tool& tool);

/// The highest of the nodes around a point; outside the map the lowest of nothing.
[[nodiscard]] double highest_near(const check::HeightMap& map, const Eigen::Vector2d& at);

}  // namespace cam::mill
