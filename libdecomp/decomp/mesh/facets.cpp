// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/facets.h"

#include "decomp/mesh/measure.h"

#include <algorithm>

namespace decomp::mesh {

Facets measure_facets(const TriMesh& mesh) {
    Facets facets;
    facets.unit.resize(mesh.triangles.size());
    facets.centre.resize(mesh.triangles.size());
    facets.area_mm2.resize(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const Eigen::Vector3d vector = double_area_normal(mesh, i);
        const double length = vector.norm();
        facets.area_mm2[i] = length / 2;
        facets.unit[i] = length > 0 ? Eigen::Vector3d(vector / length) : Eigen::Vector3d::Zero();
        facets.centre[i] = (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3;
        facets.total_mm2 += facets.area_mm2[i];
    }
    return facets;
}

std::vector<std::array<std::int32_t, 3>> neighbours(const TriMesh& mesh) {
    struct Side {
        std::uint64_t edge;  // lower point, then higher
        std::uint32_t side;  // 3 * triangle + corner
    };

    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto [low, high] =
                std::minmax(mesh.triangles[i][corner], mesh.triangles[i][(corner + 1) % 3]);
            sides.push_back(
                {(std::uint64_t{low} << 32U) | high, static_cast<std::uint32_t>(3 * i + corner)});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.side < b.side;
    });
    std::vector<std::array<std::int32_t, 3>> out(mesh.triangles.size(), {-1, -1, -1});
    for (std::size_t i = 0; i + 1 < sides.size();) {
        if (sides[i].edge != sides[i + 1].edge) {
            ++i;
            continue;
        }
        const std::uint32_t a = sides[i].side;
        const std::uint32_t b = sides[i + 1].side;
        out[a / 3][a % 3] = static_cast<std::int32_t>(b / 3);
        out[b / 3][b % 3] = static_cast<std::int32_t>(a / 3);
        i += 2;
    }
    return out;
}

}  // namespace decomp::mesh
