// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Meshes as the bytes of a file; write_file() puts them on disk. Equal meshes give equal bytes.
namespace decomp::io {

/// Binary STL. Coordinates are rounded to float32, so check the result again where that matters;
/// normals are computed from the rounded corners, 0 for a triangle without area.
[[nodiscard]] std::string stl_bytes(const mesh::TriMesh& mesh);

/// Binary little-endian PLY with double coordinates: lossless.
[[nodiscard]] std::string ply_bytes(const mesh::TriMesh& mesh);

/// The same with a colour for every face (red, green, blue, 0 ... 255), as viewers show them.
[[nodiscard]] std::string ply_bytes(const mesh::TriMesh& mesh,
                                    const std::vector<std::array<std::uint8_t, 3>>& face_colours);

/// OBJ with the shortest decimals that read back as the same double: lossless.
[[nodiscard]] std::string obj_bytes(const mesh::TriMesh& mesh);

}  // namespace decomp::io
