// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/tets/tet_mesh.h"

#include <array>
#include <cstdint>
#include <functional>
#include <map>

/// Tet meshes of known volume, made in code.
namespace tests {

/// The unit voxels (i, j, k) within `size` that `filled` holds for, six tets each (Kuhn),
/// conforming.
inline decomp::tets::TetMesh voxel_tets(const std::array<int, 3>& size,
                                        const std::function<bool(int, int, int)>& filled) {
    decomp::tets::TetMesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> number;
    const auto point = [&](const std::array<int, 3>& at) {
        const auto [found, fresh] =
            number.emplace(at, static_cast<std::uint32_t>(mesh.points.size()));
        if (fresh) {
            mesh.points.emplace_back(at[0], at[1], at[2]);
        }
        return found->second;
    };
    constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (int i = 0; i < size[0]; ++i) {
        for (int j = 0; j < size[1]; ++j) {
            for (int k = 0; k < size[2]; ++k) {
                if (!filled(i, j, k)) {
                    continue;
                }
                for (std::size_t o = 0; o < kOrders.size(); ++o) {
                    std::array<int, 3> at{i, j, k};
                    decomp::tets::Tet tet{};
                    tet[0] = point(at);
                    for (std::size_t s = 0; s < 3; ++s) {
                        ++at.at(kOrders.at(o).at(s));
                        tet.at(s + 1) = point(at);
                    }
                    // Even orders of the axes are positive, odd ones negative.
                    if (o >= 3) {
                        std::swap(tet[2], tet[3]);
                    }
                    mesh.tets.push_back(tet);
                }
            }
        }
    }
    return mesh;
}

}  // namespace tests
