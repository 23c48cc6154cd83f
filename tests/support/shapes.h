// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

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

/// Solid of revolution about Z: the profile's (radius, height) points from top to bottom, strictly
/// between two poles on the axis.
inline TriMesh revolved(double top, const std::vector<std::array<double, 2>>& profile,
                        double bottom, std::uint32_t around) {
    TriMesh mesh = sphere(1, around, static_cast<std::uint32_t>(profile.size()));
    mesh.points.front() = {0, 0, top};
    mesh.points.back() = {0, 0, bottom};
    for (std::uint32_t r = 0; r < profile.size(); ++r) {
        for (std::uint32_t a = 0; a < around; ++a) {
            const double turn = 2 * std::numbers::pi * a / around;
            mesh.points[1 + r * around + a] = {profile[r][0] * std::cos(turn),
                                               profile[r][0] * std::sin(turn), profile[r][1]};
        }
    }
    return mesh;
}

/// Two balls of the given radius joined by a smooth waist about Z, thinnest at height neck_z.
inline TriMesh dumbbell(double radius, double waist, double half_length, double neck_z,
                        std::uint32_t around) {
    std::vector<std::array<double, 2>> profile;
    constexpr int kRings = 120;
    for (int i = 1; i < kRings; ++i) {
        const double z = half_length * std::cos(std::numbers::pi * i / kRings);
        const double end = std::sqrt(std::max(0.0, 1 - std::pow(z / half_length, 4)));
        const double from_neck = (z - neck_z) / (0.35 * half_length);
        profile.push_back(
            {end * (radius - (radius - waist) * std::exp(-from_neck * from_neck)), z});
    }
    return revolved(half_length, profile, -half_length, around);
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
