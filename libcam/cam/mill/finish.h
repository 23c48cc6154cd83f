// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/cutter/drop_cutter.h"
#include "cam/cutter/surface.h"
#include "cam/mill/task.h"
#include "cam/mill/work.h"
#include "decomp/base/run.h"

#include <cstddef>

namespace cam::mill {

/// How far a finishing path may leave the surface that the drop-cutter gives: below it, mm.
inline constexpr double kFinishToleranceMm = 0.004;

/// What is left where shank or holder keep the tip up.
struct Finished {
    std::size_t nodes = 0;  ///< of the lattice that had to be finished
    std::size_t held_up = 0;
};

/// Finishes all that one tool reaches: lines on shallow faces (exact drops on a lattice and between
/// its nodes), levels on steep ones (the same lattice's level lines, each point moved onto the
/// exact surface). Both follow the part from above and never cut into it by more than the
/// tolerance. Updates the map of the stock.
/// @param rest_only  only where the stock stands more than the allowance's rest over the part
/// @error run.cancelled
[[nodiscard]] decomp::Result<Finished> finish(const Work& work, const cutter::Surface& surface,
                                              const Cutter& cutter, bool rest_only,
                                              decomp::Run& run);

/// The feet of walls on ground that a flat tool reaches and the round tips before it did not: lines
/// `step_mm` apart, where they leave more than a trace.
/// @error run.cancelled
[[nodiscard]] decomp::Status feet(const Work& work, const cutter::Surface& surface,
                                  const Cutter& cutter, double step_mm, decomp::Run& run);

/// The foot of the outline, where a round tip cannot go: level lines of a flat tool from `from_z`
/// down to the floor, `step_mm` apart.
/// @error run.cancelled
[[nodiscard]] decomp::Status contour(const Work& work, const cutter::Surface& surface,
                                     const Cutter& cutter, double from_z, double step_mm,
                                     decomp::Run& run);

}  // namespace cam::mill
