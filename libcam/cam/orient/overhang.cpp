// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/orient/overhang.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cam::orient {

namespace {

constexpr double kLevel = 0.9999;  // cosine: facets this level belong to a base

}  // namespace

Overhang find_overhang(const decomp::mesh::TriMesh& mesh, const decomp::mesh::Facets& facets,
                       const Eigen::Vector3d& down, decomp::Angle support_angle,
                       double on_plate_mm) {
    Overhang out;
    out.lie.assign(mesh.triangles.size(), Lie::Free);
    double lowest = -std::numeric_limits<double>::infinity();
    std::vector<double> depth(mesh.points.size());
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        depth[v] = down.dot(mesh.points[v]);
    }
    for (const auto& t : mesh.triangles) {
        lowest = std::max({lowest, depth[t[0]], depth[t[1]], depth[t[2]]});
    }
    const double limit = std::cos(support_angle.radians());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double downward = facets.unit[i].dot(down);
        const auto& t = mesh.triangles[i];
        if (downward <= 0) {
            continue;
        }
        if (std::min({depth[t[0]], depth[t[1]], depth[t[2]]}) >= lowest - on_plate_mm) {
            out.lie[i] = Lie::Plate;
            out.plate_mm2 += facets.area_mm2[i];
            ++out.plate_facets;
            out.base_mm2 += downward > kLevel ? facets.area_mm2[i] : 0;
        } else if (downward > limit) {
            out.lie[i] = Lie::Overhang;
            out.overhang_mm2 += facets.area_mm2[i];
            ++out.overhang_facets;
        }
    }
    return out;
}

}  // namespace cam::orient
