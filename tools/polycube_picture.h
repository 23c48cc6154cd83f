// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/polycube/generate.h"

#include <string>

namespace tools {

/// A PNG of the shape and, to its right, its polycube; both coloured by label: X red, Y green, Z
/// blue, the negative sides darker. @error those of render_meshes_png
[[nodiscard]] decomp::Result<std::string> polycube_picture(
    const decomp::polycube::Polycube& polycube, decomp::Run& run);

}  // namespace tools
