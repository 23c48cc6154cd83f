// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/part/part.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace decomp::io {

/// A part as binary little-endian PLY, bit for bit: double coordinates in the model frame, per face
/// int `source` (index of the cut plane, -1 on the input surface), int `neighbour` (index of the
/// part on the other side, -1) and int `patch` (polycube patch, -1 where unknown); the id in a line
/// `comment hew.part/1 id P01`. docs/formats.md tells the rest.
[[nodiscard]] std::string part_ply_bytes(const part::Part& part);

/// Reads what part_ply_bytes() wrote; also any PLY mesh, which is then a part of input surface
/// only.
/// @error those of read_mesh() and io.not_a_part (columns of the wrong length)
[[nodiscard]] Result<part::Part> read_part_ply(const std::filesystem::path& path);

/// As read_part_ply(), for bytes in memory; `name` stands for the file in errors.
[[nodiscard]] Result<part::Part> parse_part_ply(std::string_view bytes, std::string_view name);

}  // namespace decomp::io
