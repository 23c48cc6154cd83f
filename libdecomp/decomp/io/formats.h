// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/io/read_mesh.h"
#include "decomp/io/volume_boundary.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// One parser per format, inside the room. Each takes the whole file and the name that stands for
/// it in errors.
namespace decomp::io {

enum class Format { StlBinary, StlAscii, Obj, Off, Ply, Threemf, Medit, Step, Brep };

/// What the bytes are; the extension (lower case, with dot) decides where they could be several
/// things.
/// @error io.unknown_format, io.unsupported, io.empty
[[nodiscard]] Result<Format> detect_format(std::string_view bytes, std::string_view name);

[[nodiscard]] Result<mesh::TriMesh> parse_stl_binary(std::string_view bytes, std::string_view name);
[[nodiscard]] Result<mesh::TriMesh> parse_stl_ascii(std::string_view bytes, std::string_view name);
[[nodiscard]] Result<mesh::TriMesh> parse_obj(std::string_view bytes, std::string_view name);
[[nodiscard]] Result<mesh::TriMesh> parse_off(std::string_view bytes, std::string_view name);
[[nodiscard]] Result<mesh::TriMesh> parse_medit(std::string_view bytes, std::string_view name);

/// The cells of a volume mesh and the points of its file.
struct Volume {
    std::vector<Eigen::Vector3d> points;
    Cells cells;
};

[[nodiscard]] Result<Volume> parse_medit_volume(std::string_view bytes, std::string_view name);
[[nodiscard]] Result<Volume> parse_vtk_volume(std::string_view bytes, std::string_view name);

/// A mesh and the length of its unit; 1 where the format states none.
struct ScaledMesh {
    mesh::TriMesh mesh;
    double unit_mm = 1;
};

[[nodiscard]] Result<ScaledMesh> parse_3mf(std::string_view bytes, std::string_view name);

/// What a PLY file holds of use here.
struct PlyContents {
    std::vector<std::string> comments;
    mesh::TriMesh mesh;
    std::vector<std::vector<std::int32_t>>
        columns;  ///< per name asked for: one number a triangle, or nothing
};

/// `columns`: names of integer properties of the faces to keep.
[[nodiscard]] Result<PlyContents> parse_ply(std::string_view bytes, std::string_view name,
                                            const std::vector<std::string_view>& columns);

/// Millimetres that 1 of the file stands for. @error io.scale, io.unit
[[nodiscard]] Result<double> length_of(const ReadOptions& options, double unit_of_file_mm);

/// Multiplies all coordinates. @error io.too_large
[[nodiscard]] Status scale_points(std::vector<Eigen::Vector3d>& points, double factor,
                                  std::string_view name);

/// Merges points whose coordinates are equal and renumbers the triangles; first come, first
/// numbered. -0 equals 0.
void merge_equal_points(mesh::TriMesh& mesh);

/// Drops the points that no triangle uses; the order of the others stays.
void drop_unused_points(mesh::TriMesh& mesh);

/// Appends a polygon as triangles: a fan where it is convex, else ears are cut in the plane it
/// spans best.
void append_polygon(mesh::TriMesh& mesh, const std::vector<std::uint32_t>& corners);

}  // namespace decomp::io
