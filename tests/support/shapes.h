// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

/// Shapes with known topology and volume, outward oriented, made in code.
namespace tests {

using decomp::mesh::TriMesh;

/// Box [low, high]: 8 points, 12 triangles.
inline TriMesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    TriMesh mesh;
    for (unsigned i = 0; i < 8; ++i) {
        mesh.points.emplace_back((i & 4U) != 0 ? high.x() : low.x(),
                                 (i & 2U) != 0 ? high.y() : low.y(),
                                 (i & 1U) != 0 ? high.z() : low.z());
    }
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    return mesh;
}

/// Sphere of revolution: `around` meridians, `rings` rings between the poles.
inline TriMesh sphere(double radius, std::uint32_t around, std::uint32_t rings) {
    TriMesh mesh;
    mesh.points.emplace_back(0, 0, radius);
    for (std::uint32_t r = 1; r <= rings; ++r) {
        const double polar = std::numbers::pi * r / (rings + 1.0);
        for (std::uint32_t a = 0; a < around; ++a) {
            const double turn = 2 * std::numbers::pi * a / around;
            mesh.points.emplace_back(radius * std::sin(polar) * std::cos(turn),
                                     radius * std::sin(polar) * std::sin(turn),
                                     radius * std::cos(polar));
        }
    }
    mesh.points.emplace_back(0, 0, -radius);
    const auto at = [&](std::uint32_t ring, std::uint32_t a) {
        return 1 + ring * around + a % around;
    };
    const auto south = static_cast<std::uint32_t>(mesh.points.size() - 1);
    for (std::uint32_t a = 0; a < around; ++a) {
        mesh.triangles.push_back({0, at(0, a), at(0, a + 1)});
        for (std::uint32_t r = 0; r + 1 < rings; ++r) {
            mesh.triangles.push_back({at(r, a), at(r + 1, a), at(r + 1, a + 1)});
            mesh.triangles.push_back({at(r, a), at(r + 1, a + 1), at(r, a + 1)});
        }
        mesh.triangles.push_back({south, at(rings - 1, a + 1), at(rings - 1, a)});
    }
    return mesh;
}

/// Torus about Z, genus 1.
inline TriMesh torus(double radius, double tube, std::uint32_t around, std::uint32_t rings) {
    TriMesh mesh;
    for (std::uint32_t i = 0; i < around; ++i) {
        const double u = 2 * std::numbers::pi * i / around;
        for (std::uint32_t j = 0; j < rings; ++j) {
            const double v = 2 * std::numbers::pi * j / rings;
            const double r = radius + tube * std::cos(v);
            mesh.points.emplace_back(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
        }
    }
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
        return (i % around) * rings + j % rings;
    };
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < rings; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

/// The triangles of both, points side by side.
inline TriMesh joined(const TriMesh& a, const TriMesh& b) {
    TriMesh out = a;
    const auto shift = static_cast<std::uint32_t>(a.points.size());
    out.points.insert(out.points.end(), b.points.begin(), b.points.end());
    for (const auto& t : b.triangles) {
        out.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    }
    return out;
}

/// Inside out.
inline TriMesh flipped(TriMesh mesh) {
    for (auto& t : mesh.triangles) {
        std::swap(t[1], t[2]);
    }
    return mesh;
}

}  // namespace tests
