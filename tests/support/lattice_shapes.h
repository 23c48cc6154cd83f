// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/labeling.h"
#include "decomp/mesh/tri_mesh.h"

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

/// Polycubes made of unit cubes, with the labels that they should have.
namespace tests {

using Cube = std::array<int, 3>;

struct LabelledSurface {
    decomp::mesh::TriMesh surface;
    decomp::labels::Labeling labels;
};

/// The surface of a union of unit cubes at lattice positions, every square side cut into n x n
/// squares of two triangles. Cubes must not touch in an edge or a corner only.
inline LabelledSurface lattice_solid(const std::vector<Cube>& cubes, int n) {
    const std::set<Cube> solid(cubes.begin(), cubes.end());
    LabelledSurface out;
    std::map<Cube, std::uint32_t> index;  // by coordinates times n
    const auto vertex = [&](const Cube& at) {
        const auto [found, is_new] =
            index.emplace(at, static_cast<std::uint32_t>(out.surface.points.size()));
        if (is_new) {
            out.surface.points.emplace_back(static_cast<double>(at[0]) / n,
                                            static_cast<double>(at[1]) / n,
                                            static_cast<double>(at[2]) / n);
        }
        return found->second;
    };
    for (const Cube& cube : solid) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int sign : {1, -1}) {
                Cube next = cube;
                next.at(static_cast<std::size_t>(axis)) += sign;
                if (solid.contains(next)) {
                    continue;
                }
                const auto u = static_cast<std::size_t>((axis + 1) % 3);
                const auto v = static_cast<std::size_t>((axis + 2) % 3);
                for (int i = 0; i < n * n; ++i) {
                    const auto corner = [&](int du, int dv) {
                        Cube at{cube[0] * n, cube[1] * n, cube[2] * n};
                        at.at(static_cast<std::size_t>(axis)) += sign > 0 ? n : 0;
                        at.at(u) += i / n + du;
                        at.at(v) += i % n + dv;
                        return vertex(at);
                    };
                    const auto a = corner(0, 0);
                    const auto b = sign > 0 ? corner(1, 0) : corner(0, 1);
                    const auto c = corner(1, 1);
                    const auto d = sign > 0 ? corner(0, 1) : corner(1, 0);
                    out.surface.triangles.push_back({a, b, c});
                    out.surface.triangles.push_back({a, c, d});
                    out.labels.resize(out.labels.size() + 2, decomp::labels::label_of(axis, sign));
                }
            }
        }
    }
    return out;
}

/// Eight cubes around a square hole.
inline LabelledSurface lattice_ring(int n) {
    std::vector<Cube> cubes;
    for (int x = 0; x < 3; ++x) {
        for (int y = 0; y < 3; ++y) {
            if (x != 1 || y != 1) {
                cubes.push_back({x, y, 0});
            }
        }
    }
    return lattice_solid(cubes, n);
}

}  // namespace tests
