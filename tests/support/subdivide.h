// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tests {

/// The same surface with four triangles for each one.
inline decomp::mesh::TriMesh midpoint_subdivided(const decomp::mesh::TriMesh& mesh) {
    decomp::mesh::TriMesh out;
    out.points = mesh.points;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                     static_cast<std::uint32_t>(out.points.size()));
        if (fresh) {
            out.points.emplace_back((mesh.points[a] + mesh.points[b]) / 2);
        }
        return at->second;
    };
    for (const auto& t : mesh.triangles) {
        const std::uint32_t ab = middle(t[0], t[1]);
        const std::uint32_t bc = middle(t[1], t[2]);
        const std::uint32_t ca = middle(t[2], t[0]);
        out.triangles.insert(out.triangles.end(),
                             {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    return out;
}

/// The same surface with about twice the triangles: pairs that share a side are cut at its middle;
/// the few triangles that find no partner stay.
inline decomp::mesh::TriMesh doubled(const decomp::mesh::TriMesh& mesh) {
    decomp::mesh::TriMesh out;
    out.points = mesh.points;
    std::vector<char> done(mesh.triangles.size(), 0);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> sides;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const auto [low, high] =
                std::minmax(mesh.triangles[i][c], mesh.triangles[i][(c + 1) % 3]);
            sides[{low, high}].push_back(i);
        }
    }
    for (const auto& [side, both] : sides) {
        if (both.size() != 2 || done[both[0]] != 0 || done[both[1]] != 0) {
            continue;
        }
        const auto middle = static_cast<std::uint32_t>(out.points.size());
        out.points.emplace_back((mesh.points[side.first] + mesh.points[side.second]) / 2);
        for (const std::size_t i : both) {
            done[i] = 1;
            const auto& t = mesh.triangles[i];
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint32_t a = t[c];
                const std::uint32_t b = t[(c + 1) % 3];
                if (std::minmax(a, b) == std::minmax(side.first, side.second)) {
                    out.triangles.push_back({a, middle, t[(c + 2) % 3]});
                    out.triangles.push_back({middle, b, t[(c + 2) % 3]});
                }
            }
        }
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (done[i] == 0) {
            out.triangles.push_back(mesh.triangles[i]);
        }
    }
    return out;
}

}  // namespace tests
