// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/fdm.h"
#include "cam/check/mill3.h"
#include "cam/check/mill4.h"
#include "cam/render/render.h"
#include "tools/check_input.h"

#include <string>
#include <vector>

namespace tools {

/// A coloured part as it is drawn.
struct ColouredPart {
    const decomp::part::Part* part = nullptr;
    std::vector<cam::render::Rgb> colours;  ///< of each facet
    std::vector<cam::render::Stroke> strokes;
    std::vector<cam::render::Legend> legend;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< how it stands in the picture
    std::string suffix;                                  ///< of the files' names
};

/// Writes PART.ply (colour per face, model frame) and PART.png into the directory of `--out`;
/// nothing without one. @error those of render and file
[[nodiscard]] decomp::Status draw(const CheckRequest& request, const ColouredPart& coloured,
                                  decomp::Run& run);

/// The part in the pose of its base, coloured by what hangs.
[[nodiscard]] decomp::Status draw_printing(const CheckRequest& request,
                                           const decomp::part::Part& part,
                                           const Eigen::Vector3d& down,
                                           const cam::check::FdmOptions& options, decomp::Run& run);

/// The part as it is clamped, coloured by what rays see and the first tool reaches.
[[nodiscard]] decomp::Status draw_milling(const CheckRequest& request,
                                          const decomp::part::Part& part,
                                          const cam::check::Mill3Check& check,
                                          const Eigen::Vector3d& direction, decomp::Run& run);

/// The part with its rotary axis through it and the tool's directions, coloured by the position of
/// A that sees each facet first; where a tool was asked, also what it does not reach.
[[nodiscard]] decomp::Status draw_rotary(const CheckRequest& request,
                                         const decomp::part::Part& part,
                                         const cam::check::Mill4Check& check,
                                         const cam::check::Mill4Options& options, decomp::Run& run);

}  // namespace tools
