// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/io/read_mesh.h"
#include "decomp/tets/tet_mesh.h"

#include <filesystem>

namespace decomp::io {

/// Reads the tets of a Medit .mesh file or of a legacy VTK file (ASCII). Hexahedra are cut into six
/// tets each, along the diagonals of the lowest corners: conforming, and the same for two files
/// that name the same corners. Points and tets keep the order of the file; tets may be of either
/// sense.
/// @error file.not_found, file.unreadable, io.unknown_format, io.unsupported, io.syntax,
/// io.truncated, io.index_out_of_range, io.not_finite, io.too_large, io.empty (no tet), io.unit,
/// io.scale
[[nodiscard]] Result<tets::TetMesh> read_tets(const std::filesystem::path& path,
                                              const ReadOptions& options);

/// As read_tets(), for bytes in memory.
[[nodiscard]] Result<tets::TetMesh> parse_tets(std::string_view bytes, std::string_view name,
                                               const ReadOptions& options);

}  // namespace decomp::io
