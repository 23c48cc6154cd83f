// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/render.h"

#include <algorithm>
#include <array>
#include <map>

namespace cam::render {

namespace {

constexpr double kLeastSegmentMm = 1e-6;

/// A straight piece of a bead as a box, lengthened by half its width at both ends so that corners
/// are filled.
void append_box(decomp::mesh::TriMesh& mesh, const std::array<Eigen::Vector2d, 2>& ends,
                const path::Bead& bead, double top_mm) {
    const Eigen::Vector2d along = (ends[1] - ends[0]).normalized() * (bead.width_mm / 2);
    const Eigen::Vector2d left(-along.y(), along.x());
    const std::array<Eigen::Vector2d, 4> ring = {ends[0] - along - left, ends[1] + along - left,
                                                 ends[1] + along + left, ends[0] - along + left};
    const auto base = static_cast<std::uint32_t>(mesh.points.size());
    for (const double z : {top_mm - bead.height_mm, top_mm}) {
        for (const auto& corner : ring) {
            mesh.points.emplace_back(corner.x(), corner.y(), z);
        }
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t j = (i + 1) % 4;
        mesh.triangles.push_back({base + i, base + j, base + 4 + j});
        mesh.triangles.push_back({base + i, base + 4 + j, base + 4 + i});
    }
    mesh.triangles.push_back({base, base + 2, base + 1});
    mesh.triangles.push_back({base, base + 3, base + 2});
    mesh.triangles.push_back({base + 4, base + 5, base + 6});
    mesh.triangles.push_back({base + 4, base + 6, base + 7});
}

void append(decomp::mesh::TriMesh& mesh, const path::Bead& bead, double top_mm) {
    for (std::size_t p = 0; p + 1 < bead.points.size(); ++p) {
        if ((bead.points[p + 1] - bead.points[p]).norm() > kLeastSegmentMm) {
            append_box(mesh, {bead.points[p], bead.points[p + 1]}, bead, top_mm);
        }
    }
}

}  // namespace

std::vector<BeadMesh> bead_meshes(const path::LayerStack& stack, std::size_t first,
                                  std::size_t last) {
    std::map<path::Feature, decomp::mesh::TriMesh> by_feature;
    for (std::size_t i = first; i < std::min(last, stack.layers.size()); ++i) {
        for (const auto& bead : stack.layers[i].beads) {
            append(by_feature[bead.feature], bead, stack.layers[i].z_mm);
        }
    }
    std::vector<BeadMesh> meshes;
    meshes.reserve(by_feature.size());
    for (auto& [feature, mesh] : by_feature) {
        meshes.push_back({feature, std::move(mesh)});
    }
    return meshes;
}

}  // namespace cam::render
