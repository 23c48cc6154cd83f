// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/read_tets.h"

#include "decomp/base/file.h"
#include "decomp/io/formats.h"

#include <algorithm>
#include <array>

namespace decomp::io {

namespace {

// Corners of a hexahedron: bottom ring, top ring. Any sense: only which corners share a face
// counts.
constexpr std::array<std::array<std::size_t, 4>, 6> kHexFaces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// Six tets about the lowest corner, over the three faces that do not hold it, each face cut along
/// the diagonal of its own lowest corner: neighbours cut their common face alike.
void append_hexahedron(const std::array<std::uint32_t, 8>& corners, std::vector<tets::Tet>& out) {
    const std::uint32_t apex = *std::min_element(corners.begin(), corners.end());
    for (const auto& face : kHexFaces) {
        std::array<std::uint32_t, 4> ring{};
        for (std::size_t k = 0; k < 4; ++k) {
            ring.at(k) = corners.at(face.at(k));
        }
        if (std::find(ring.begin(), ring.end(), apex) != ring.end()) {
            continue;
        }
        std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
        out.push_back({apex, ring[0], ring[1], ring[2]});
        out.push_back({apex, ring[0], ring[2], ring[3]});
    }
}

}  // namespace

Result<tets::TetMesh> parse_tets(std::string_view bytes, std::string_view name,
                                 const ReadOptions& options) {
    constexpr std::string_view kVtk = "# vtk DataFile";
    constexpr std::string_view kMedit = "MeshVersionFormatted";
    Result<Volume> volume;
    if (bytes.substr(0, kVtk.size()) == kVtk) {
        volume = parse_vtk_volume(bytes, name);
    } else if (bytes.substr(0, 4096).find(kMedit) != std::string_view::npos) {
        volume = parse_medit_volume(bytes, name);
    } else {
        return fail("io.unknown_format", "neither a Medit .mesh nor a legacy VTK file",
                    std::string(name), "save the tets as one of the two");
    }
    if (!volume) {
        return fail(volume.error());
    }
    const Result<double> length = length_of(options, 1);
    if (!length) {
        return fail(length.error());
    }
    tets::TetMesh mesh;
    mesh.points = std::move(volume->points);
    if (Status status = scale_points(mesh.points, *length, name); !status) {
        return fail(status.error());
    }
    const auto& tetrahedra = volume->cells.tetrahedra;
    for (std::size_t i = 0; i + 4 <= tetrahedra.size(); i += 4) {
        mesh.tets.push_back(
            {tetrahedra[i], tetrahedra[i + 1], tetrahedra[i + 2], tetrahedra[i + 3]});
    }
    const auto& hexahedra = volume->cells.hexahedra;
    for (std::size_t i = 0; i + 8 <= hexahedra.size(); i += 8) {
        std::array<std::uint32_t, 8> corners{};
        std::copy_n(hexahedra.begin() + static_cast<std::ptrdiff_t>(i), 8, corners.begin());
        append_hexahedron(corners, mesh.tets);
    }
    if (mesh.tets.empty()) {
        return fail("io.empty", "the file holds neither tets nor hexahedra", std::string(name),
                    "a surface is no polycube map: give the volume meshes");
    }
    return mesh;
}

Result<tets::TetMesh> read_tets(const std::filesystem::path& path, const ReadOptions& options) {
    const Result<std::string> bytes = read_file(path);
    if (!bytes) {
        return fail(bytes.error());
    }
    return parse_tets(*bytes, path.string(), options);
}

}  // namespace decomp::io
