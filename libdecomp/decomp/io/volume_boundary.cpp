// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/volume_boundary.h"

#include "decomp/mesh/measure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>

namespace decomp::io {

namespace {

/// A face of one cell. Triangles repeat their last corner.
struct CellFace {
    std::array<std::uint32_t, 4> key{};  ///< corners, sorted; the fourth of a triangle is kNoCorner
    std::array<std::uint32_t, 4>
        corners{};  ///< as the cell lists them, outward in a cell of positive volume
    Eigen::Vector3d inner = Eigen::Vector3d::Zero();  ///< centre of the cell

    [[nodiscard]] bool is_quad() const { return corners[2] != corners[3]; }
};

constexpr std::uint32_t kNoCorner = std::numeric_limits<std::uint32_t>::max();

// Outward for a tetrahedron with (b - a) x (c - a) . (d - a) > 0.
constexpr std::array<std::array<std::size_t, 4>, 4> kTetFaces{
    {{0, 2, 1, 1}, {0, 1, 3, 3}, {1, 2, 3, 3}, {2, 0, 3, 3}}};
constexpr std::array<std::array<std::size_t, 4>, 6> kHexFaces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

template <std::size_t Faces>
void append_faces(const std::vector<std::uint32_t>& cells, std::size_t corners,
                  const std::array<std::array<std::size_t, 4>, Faces>& table,
                  const mesh::TriMesh& mesh, std::vector<CellFace>& faces) {
    for (std::size_t cell = 0; cell + corners <= cells.size(); cell += corners) {
        Eigen::Vector3d inner = Eigen::Vector3d::Zero();
        for (std::size_t k = 0; k < corners; ++k) {
            inner += mesh.points[cells[cell + k]] / static_cast<double>(corners);
        }
        for (const auto& row : table) {
            CellFace face;
            for (std::size_t k = 0; k < 4; ++k) {
                face.corners.at(k) = cells[cell + row.at(k)];
            }
            face.key = face.corners;
            face.key[3] = face.is_quad() ? face.key[3] : kNoCorner;
            std::sort(face.key.begin(), face.key.end());
            face.inner = inner;
            faces.push_back(face);
        }
    }
}

std::size_t corner_count(const CellFace& face) { return face.is_quad() ? 4 : 3; }

/// The corners from the lowest on, in their own sense.
std::array<std::uint32_t, 4> rotated(const CellFace& face) {
    std::array<std::uint32_t, 4> out = face.corners;
    const auto end = out.begin() + static_cast<std::ptrdiff_t>(corner_count(face));
    std::rotate(out.begin(), std::min_element(out.begin(), end), end);
    return out;
}

/// Whether two cells list their common face in opposite senses, as they do where both have the same
/// handedness.
bool opposite(const CellFace& a, const CellFace& b) {
    const std::size_t n = corner_count(a);
    return corner_count(b) == n && rotated(a)[1] == rotated(b).at(n - 1);
}

void append_triangles(const CellFace& face, mesh::TriMesh& mesh) {
    const auto c = rotated(face);
    mesh.triangles.push_back({c[0], c[1], c[2]});
    if (face.is_quad()) {
        mesh.triangles.push_back({c[0], c[2], c[3]});
    }
}

bool faces_its_cell(const CellFace& face, const mesh::TriMesh& mesh) {
    const auto c = rotated(face);
    const Eigen::Vector3d a = mesh.points[c[0]];
    const Eigen::Vector3d last = mesh.points[c.at(corner_count(face) - 1)];
    const Eigen::Vector3d middle = mesh.points[c[corner_count(face) == 4 ? 2 : 1]];
    return (middle - a).cross(last - a).dot(face.inner - a) > 0;
}

}  // namespace

mesh::TriMesh boundary_of(const Cells& cells, mesh::TriMesh mesh) {
    std::vector<CellFace> faces;
    faces.reserve(cells.tetrahedra.size() + cells.hexahedra.size());
    append_faces(cells.tetrahedra, 4, kTetFaces, mesh, faces);
    append_faces(cells.hexahedra, 8, kHexFaces, mesh, faces);
    std::stable_sort(faces.begin(), faces.end(),
                     [](const CellFace& l, const CellFace& r) { return l.key < r.key; });
    mesh.triangles.clear();
    std::vector<CellFace> boundary;
    bool one_sense = true;
    for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
        for (end = begin; end < faces.size() && faces[end].key == faces[begin].key; ++end) {
        }
        if (end - begin == 1) {
            boundary.push_back(faces[begin]);
        } else {
            one_sense = one_sense && end - begin == 2 && opposite(faces[begin], faces[begin + 1]);
        }
    }
    for (CellFace& face : boundary) {
        if (!one_sense && faces_its_cell(face, mesh)) {
            const bool quad = face.is_quad();
            std::reverse(face.corners.begin(), face.corners.begin() + (quad ? 4 : 3));
            face.corners[3] = quad ? face.corners[3] : face.corners[2];
        }
        append_triangles(face, mesh);
    }
    if (one_sense && mesh::volume_mm3(mesh) < 0) {
        for (auto& triangle : mesh.triangles) {
            std::swap(triangle[1], triangle[2]);
        }
    }
    return mesh;
}

}  // namespace decomp::io
