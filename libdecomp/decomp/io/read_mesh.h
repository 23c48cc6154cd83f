// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace decomp::io {

struct ReadOptions {
    double scale = 1;    ///< every coordinate is multiplied by it, after the unit; finite, above 0
    std::string unit;    ///< "um", "mm", "cm", "m", "in" or "ft"; empty: the unit that the file
                         ///< states, else mm
    std::string body{};  ///< of STEP and BREP: the body wanted; empty or "all": every one
    std::optional<double> deflection_mm{};  ///< of STEP and BREP: chord error, before `scale`;
                                            ///< default: brep::default_deflection_mm()
    double angle = 0.35;  ///< of STEP and BREP: turn between chords at most, radians
};

/// Reads STL (binary, ASCII), OBJ, OFF, PLY, 3MF, Medit .mesh, STEP or CASCADE .brep. The format is
/// known by content; the extension only decides where the content fits several. Points are in mm;
/// STL corners are merged where their bytes agree; polygons are cut into triangles; of tetrahedra
/// and hexahedra the boundary is taken, oriented outward; of STEP and BREP the solids, cut into
/// triangles (see read_brep.h). Nothing is repaired: the result may be open, flipped or intersect
/// itself (see repair.h). Points that no triangle uses are dropped.
/// @error file.not_found, file.unreadable, io.unknown_format, io.unsupported, io.syntax,
/// io.truncated,
///        io.index_out_of_range, io.not_finite, io.too_large, io.empty, io.unit, io.scale,
///        io.threemf, those of brep::read_brep(), io.not_a_solid_model (options of STEP for
///        another format); `where` names the file and the line or the byte
/// Cost O(n log n) for STL and volume meshes, O(n) for the others. Memory stays within a small
/// multiple of the file.
[[nodiscard]] Result<mesh::TriMesh> read_mesh(const std::filesystem::path& path,
                                              const ReadOptions& options, const Run& run);

/// As read_mesh(), for bytes in memory; `name` stands for the file in errors, its extension counts
/// as above.
[[nodiscard]] Result<mesh::TriMesh> parse_mesh(std::string_view bytes, std::string_view name,
                                               const ReadOptions& options, const Run& run);

}  // namespace decomp::io
