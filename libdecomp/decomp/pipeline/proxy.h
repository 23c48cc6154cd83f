// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/part/part.h"

#include <cstddef>

/// Inside the room: a light stand-in for a part, on which planes are searched.
namespace decomp::pipeline {

/// The part with at most about `triangles` facets, by edge collapse (Lindstrom and Turk). Cut
/// facets stay as they are. Returned unchanged when it is small already, or is not manifold.
[[nodiscard]] part::Part simplified(const part::Part& part, std::size_t triangles);

}  // namespace decomp::pipeline
