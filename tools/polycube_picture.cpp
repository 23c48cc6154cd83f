// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/polycube_picture.h"

#include "cam/render/render.h"
#include "decomp/mesh/measure.h"
#include "decomp/tets/boundary.h"

#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace tools {

namespace {

using decomp::labels::kLabelCount;
using decomp::mesh::TriMesh;

constexpr std::array<cam::render::Rgb, kLabelCount> kColours{{{226, 106, 92},
                                                              {160, 62, 54},
                                                              {120, 190, 110},
                                                              {66, 126, 62},
                                                              {104, 146, 222},
                                                              {58, 88, 160}}};
constexpr double kGap = 0.15;  // of the larger diagonal, between the two

/// One mesh for each label, over points without those that no triangle uses.
std::vector<TriMesh> by_label(const std::vector<Eigen::Vector3d>& points,
                              const decomp::polycube::Polycube& polycube) {
    std::vector<TriMesh> out(kLabelCount);
    const auto facets = decomp::tets::boundary_of(polycube.pair.tets);
    for (std::size_t i = 0; i < facets.size(); ++i) {
        TriMesh& mesh = out[static_cast<std::size_t>(polycube.labels[i])];
        decomp::mesh::Triangle triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.at(k) = static_cast<std::uint32_t>(mesh.points.size());
            mesh.points.push_back(points[facets[i].corners.at(k)]);
        }
        mesh.triangles.push_back(triangle);
    }
    return out;
}

Eigen::AlignedBox3d bounds(const std::vector<TriMesh>& meshes) {
    Eigen::AlignedBox3d box;
    for (const TriMesh& mesh : meshes) {
        box.extend(decomp::mesh::bounds(mesh));
    }
    return box;
}

}  // namespace

decomp::Result<std::string> polycube_picture(const decomp::polycube::Polycube& polycube,
                                             decomp::Run& run) {
    // The shape is drawn as the polycube stands, so that the two compare.
    std::vector<Eigen::Vector3d> turned;
    for (const Eigen::Vector3d& p : polycube.pair.shape) {
        turned.emplace_back(polycube.rotation * p);
    }
    const std::vector<TriMesh> shape = by_label(turned, polycube);
    const std::vector<TriMesh> cube = by_label(polycube.pair.polycube, polycube);
    const Eigen::AlignedBox3d left = bounds(shape);
    const Eigen::AlignedBox3d right = bounds(cube);
    // Side by side as the viewer of the iso view sees it: along the horizontal of the picture.
    const Eigen::Vector3d sideways = Eigen::Vector3d(1, 1, 0).normalized();
    const double gap = (1 + kGap) * std::max(left.diagonal().norm(), right.diagonal().norm());
    const Eigen::Vector3d offset = left.center() - right.center() + gap * sideways;
    std::vector<cam::render::Item> items;
    for (const auto& [meshes, shift] :
         {std::pair<const std::vector<TriMesh>*, Eigen::Vector3d>{&shape, Eigen::Vector3d::Zero()},
          std::pair<const std::vector<TriMesh>*, Eigen::Vector3d>{&cube, offset}}) {
        for (std::size_t label = 0; label < meshes->size(); ++label) {
            if (!(*meshes)[label].triangles.empty()) {
                cam::render::Item item;
                item.mesh = &(*meshes)[label];
                item.colour = kColours.at(label);
                item.offset = shift;
                items.push_back(item);
            }
        }
    }
    constexpr int kWidthPx = 1600;
    constexpr int kHeightPx = 800;
    return cam::render::render_meshes_png(items, {.width_px = kWidthPx, .height_px = kHeightPx},
                                          run);
}

}  // namespace tools
