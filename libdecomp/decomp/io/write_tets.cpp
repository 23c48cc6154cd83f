// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/write_tets.h"

#include "decomp/base/assert.h"
#include "decomp/base/number.h"
#include "decomp/tets/boundary.h"

namespace decomp::io {

namespace {

void append_point(std::string& out, const Eigen::Vector3d& p) {
    out += shortest(p.x()) + " " + shortest(p.y()) + " " + shortest(p.z());
}

template <class Corners>
void append_corners(std::string& out, const Corners& corners, std::uint32_t first) {
    for (const std::uint32_t corner : corners) {
        out += std::to_string(corner + first) + " ";
    }
}

}  // namespace

std::string medit_bytes(std::span<const Eigen::Vector3d> points, std::span<const tets::Tet> tets,
                        std::span<const int> references) {
    const auto facets = tets::boundary_of(tets);
    DECOMP_ASSERT(references.empty() || references.size() == facets.size());
    std::string out = "MeshVersionFormatted 2\nDimension 3\nVertices\n";
    out += std::to_string(points.size()) + "\n";
    for (const Eigen::Vector3d& p : points) {
        append_point(out, p);
        out += " 0\n";
    }
    out += "Triangles\n" + std::to_string(facets.size()) + "\n";
    for (std::size_t i = 0; i < facets.size(); ++i) {
        append_corners(out, facets[i].corners, 1);
        out += std::to_string(references.empty() ? 0 : references[i]) + "\n";
    }
    out += "Tetrahedra\n" + std::to_string(tets.size()) + "\n";
    for (const tets::Tet& tet : tets) {
        append_corners(out, tet, 1);
        out += "0\n";
    }
    return out + "End\n";
}

std::string vtk_bytes(std::span<const Eigen::Vector3d> points, std::span<const tets::Tet> tets) {
    std::string out =
        "# vtk DataFile Version 3.0\ntets\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
        std::to_string(points.size()) + " double\n";
    for (const Eigen::Vector3d& p : points) {
        append_point(out, p);
        out += "\n";
    }
    out += "CELLS " + std::to_string(tets.size()) + " " + std::to_string(5 * tets.size()) + "\n";
    for (const tets::Tet& tet : tets) {
        out += "4 ";
        append_corners(out, tet, 0);
        out.back() = '\n';
    }
    out += "CELL_TYPES " + std::to_string(tets.size()) + "\n";
    for (std::size_t i = 0; i < tets.size(); ++i) {
        out += "10\n";
    }
    return out;
}

}  // namespace decomp::io
