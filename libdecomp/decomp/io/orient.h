// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

#include <optional>
#include <string_view>

namespace decomp::io {

/// Which axis of the file points up. Auto: see choose_up().
enum class Up { X, MinusX, Y, MinusY, Z, MinusZ, Auto };

/// "x", "-x", "y", "-y", "z", "-z" or "auto". @error io.up
[[nodiscard]] Result<Up> parse_up(std::string_view text);

[[nodiscard]] std::string_view name_of(Up up);

/// The axis on which the shape stands best: the one with the largest flat base at its lower end
/// (faces within 5 degrees of level and within 0.5 % of the extent from the bottom), if that base
/// covers 5 % of the bounding rectangle; otherwise Z. Ties in the order Z, Y, -Y, X, -X, -Z. O(n).
[[nodiscard]] Up choose_up(const mesh::TriMesh& mesh);

/// Turns the up axis to +Z (exactly: a permutation of coordinates with signs), then scales about
/// the origin so that the extent along Z is height_mm. A flat shape (no extent along Z) is not
/// scaled.
[[nodiscard]] mesh::TriMesh to_model_frame(mesh::TriMesh mesh, Up up,
                                           std::optional<double> height_mm);

}  // namespace decomp::io
