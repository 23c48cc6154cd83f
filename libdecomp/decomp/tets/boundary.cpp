// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/boundary.h"

#include <algorithm>

namespace decomp::tets {

namespace {

struct Face {
    mesh::Triangle sorted{};
    std::uint32_t tet = 0;
    std::uint32_t k = 0;
};

/// All faces, equal ones side by side, by rising tet within.
std::vector<Face> sorted_faces(std::span<const Tet> tets) {
    std::vector<Face> faces;
    faces.reserve(4 * tets.size());
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
        for (std::uint32_t k = 0; k < 4; ++k) {
            mesh::Triangle corners = face_of(tets[t], k);
            std::sort(corners.begin(), corners.end());
            faces.push_back({corners, t, k});
        }
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return a.sorted != b.sorted ? a.sorted < b.sorted
                                    : (a.tet != b.tet ? a.tet < b.tet : a.k < b.k);
    });
    return faces;
}

}  // namespace

mesh::Triangle face_of(const Tet& tet, std::size_t k) {
    // Face k of a positive tet, outward: the even permutations of (k, a, c, b).
    static constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
        {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    const auto& f = kFaces.at(k);
    return {tet.at(f[0]), tet.at(f[1]), tet.at(f[2])};
}

std::vector<BoundaryFacet> boundary_of(std::span<const Tet> tets) {
    const std::vector<Face> faces = sorted_faces(tets);
    std::vector<std::array<std::uint32_t, 2>> lone;
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end].sorted == faces[i].sorted) {
            ++end;
        }
        if (end == i + 1) {
            lone.push_back({faces[i].tet, faces[i].k});
        }
        i = end;
    }
    std::sort(lone.begin(), lone.end());
    std::vector<BoundaryFacet> boundary;
    boundary.reserve(lone.size());
    for (const auto& [tet, k] : lone) {
        boundary.push_back({face_of(tets[tet], k), tet});
    }
    return boundary;
}

std::vector<std::array<std::int32_t, 4>> neighbours_of(std::span<const Tet> tets) {
    std::vector<std::array<std::int32_t, 4>> neighbours(tets.size(), {-1, -1, -1, -1});
    const std::vector<Face> faces = sorted_faces(tets);
    for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
        const Face& a = faces[i];
        const Face& b = faces[i + 1];
        if (a.sorted == b.sorted) {
            neighbours[a.tet].at(a.k) = static_cast<std::int32_t>(b.tet);
            neighbours[b.tet].at(b.k) = static_cast<std::int32_t>(a.tet);
        }
    }
    return neighbours;
}

BoundarySurface boundary_surface(std::span<const Eigen::Vector3d> points,
                                 std::span<const Tet> tets) {
    BoundarySurface out;
    const std::vector<BoundaryFacet> facets = boundary_of(tets);
    std::vector<std::int64_t> number(points.size(), -1);
    for (const BoundaryFacet& facet : facets) {
        for (const std::uint32_t corner : facet.corners) {
            number[corner] = 0;
        }
    }
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (number[i] == 0) {
            number[i] = static_cast<std::int64_t>(out.points_from.size());
            out.points_from.push_back(i);
            out.surface.points.push_back(points[i]);
        }
    }
    out.surface.triangles.reserve(facets.size());
    for (const BoundaryFacet& facet : facets) {
        mesh::Triangle triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.at(k) = static_cast<std::uint32_t>(number[facet.corners.at(k)]);
        }
        out.surface.triangles.push_back(triangle);
    }
    return out;
}

}  // namespace decomp::tets
