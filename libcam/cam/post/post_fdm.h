// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/motion/estimate.h"
#include "cam/path/layers.h"
#include "cam/profile/read_profile.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"

#include <string>

namespace cam::post {

struct PostOptions {
    std::string
        title;  ///< stands in a comment and in the {title} placeholder, e.g. "P03" or "plate 2"
};

/// A program as the machine (or its converter) reads it.
struct Program {
    std::string text;
    motion::Estimate estimate;
};

/// Writes the program of one plate: start template, layers with their temperatures, fan and
/// progress, end template. Layers too short to cool are slowed first (motion::cooled). Comments say
/// what each bead is (";LAYER:", ";TYPE:", ";Z:",
/// ";HEIGHT:", ";WIDTH:") and sum up time and filament. Serial, O(points), about 30 MB of text a
/// second.
/// @param on_bed  in the machine's coordinates, layers in ascending order
/// @error post.empty (no bead), post.bad_layer (heights that do not rise, numbers that are none),
/// post.outside_chamber, post.forbidden_word, profile.template_name, profile.template_syntax,
/// run.cancelled
[[nodiscard]] decomp::Result<Program> post_fdm(const path::LayerStack& on_bed,
                                               const profile::FdmSetup& setup,
                                               const PostOptions& options, const decomp::Run& run);

}  // namespace cam::post
