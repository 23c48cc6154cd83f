// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/measure.h"
#include "decomp/solid/make_solid.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

/// Solids of meshes, and what must be true of them.
namespace tests {

inline decomp::solid::MadeSolid made(const decomp::mesh::TriMesh& mesh,
                                     const decomp::solid::SolidOptions& options = {
                                         .tolerance_mm = 0.02}) {
    const auto solid = decomp::solid::make_solid({"P01", mesh, {}}, options, decomp::Run{});
    EXPECT_TRUE(solid) << (solid ? "" : solid.error().text());
    return solid ? *solid : decomp::solid::MadeSolid{};
}

/// The mesh somewhere else, along no axis.
inline decomp::mesh::TriMesh turned(const decomp::mesh::TriMesh& mesh) {
    return decomp::mesh::transformed(
        mesh, Eigen::Affine3d(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()) *
                              Eigen::Translation3d(3, 4, 5)));
}

/// What an STL keeps of it.
inline decomp::mesh::TriMesh in_float(decomp::mesh::TriMesh mesh) {
    for (Eigen::Vector3d& p : mesh.points) {
        p = p.cast<float>().cast<double>();
    }
    return mesh;
}

/// V - E + F, with one more loop counted for every hole in a face.
inline long euler(const decomp::solid::MadeSolid& solid) {
    long holes = 0;
    for (const auto& face : solid.solid.faces) {
        holes += static_cast<long>(face.loops.size()) - 1;
    }
    return static_cast<long>(solid.solid.vertices.size()) -
           static_cast<long>(solid.solid.edges.size()) +
           static_cast<long>(solid.solid.faces.size()) - holes;
}

/// The largest distance between the ends of an edge and the surfaces on either side of it, and
/// between its middle and them.
inline double farthest_off(const decomp::solid::MadeSolid& solid) {
    double farthest = 0;
    for (const auto& face : solid.solid.faces) {
        for (const auto& loop : face.loops) {
            for (const auto& use : loop) {
                const auto& edge = solid.solid.edges[static_cast<std::size_t>(use.edge)];
                for (const double s : {0.0, 0.3, 0.7, 1.0}) {
                    const auto p =
                        decomp::solid::point_at(edge.curve, edge.t0 + s * (edge.t1 - edge.t0));
                    farthest =
                        std::max(farthest, std::abs(decomp::solid::distance_mm(face.surface, p)));
                }
            }
        }
    }
    return farthest;
}

/// The surfaces of one kind, face by face.
template <class Kind>
std::vector<Kind> surfaces_of(const decomp::solid::MadeSolid& solid) {
    std::vector<Kind> found;
    for (const auto& face : solid.solid.faces) {
        if (const auto* surface = std::get_if<Kind>(&face.surface)) {
            found.push_back(*surface);
        }
    }
    return found;
}

}  // namespace tests
