// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/render/ray_scene_detail.h"
#include "cam/render/view_detail.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace cam::render {

/// Unit normals for each corner of each triangle: averaged over the triangles around the vertex
/// that bend less than a crease, so that curved surfaces look smooth and edges stay sharp. 3 for
/// each triangle.
[[nodiscard]] std::vector<Eigen::Vector3f> corner_normals(const decomp::mesh::TriMesh& mesh);

/// What one sample of the picture sees.
struct Sample {
    std::int32_t item = -1;  ///< -1: background
    float distance = 0;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< smooth, turned to the viewer
    Eigen::Vector3f flat_normal =
        Eigen::Vector3f::Zero();  ///< of the triangle, turned to the viewer
    bool highlighted = false;
    std::uint32_t triangle = 0;
};

/// Fraction of light, 0 ... 1, that reaches a surface with this normal from lamps that move with
/// the camera, `open` of the sky being visible.
[[nodiscard]] double light_on(const Eigen::Vector3f& normal, const Camera& camera, double open);

/// Direction number `index` of 16 over the hemisphere around the normal, cosine-weighted; sixteen
/// slots have sixteen such sets, which together cover it evenly.
[[nodiscard]] Eigen::Vector3f sky_direction(const Eigen::Vector3f& normal, int index, int slot);

inline constexpr int kSkyDirections = 16;

}  // namespace cam::render
