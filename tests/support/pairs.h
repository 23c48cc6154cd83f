// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"
#include "decomp/tets/tet_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

/// Shapes made of voxels whose polycube map is known: they are their own polycubes, bent or not.
namespace tests {

using Voxel = std::array<int, 3>;
using Bend = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// A pair, its lattice and its surface.
struct VoxelPair {
    decomp::tets::Pair pair;
    decomp::tets::Lattice lattice;
    decomp::mesh::TriMesh surface;  ///< closed and outward; the points of `pair` come first
    double volume_mm3 = 0;
};

/// Voxels of `size_mm`, each cut into `fine`^3 cubes of six tets (Kuhn), and the planes between
/// all voxels. `bend` takes the polycube to the shape; it must keep turns.
inline VoxelPair voxel_pair(
    const std::vector<Voxel>& voxels, double size_mm, int fine,
    const Bend& bend = [](const Eigen::Vector3d& p) { return p; }) {
    VoxelPair out;
    std::map<Voxel, std::uint32_t> number;
    const auto point = [&](const Voxel& at) {
        const auto [entry, is_new] =
            number.try_emplace(at, static_cast<std::uint32_t>(number.size()));
        if (is_new) {
            const Eigen::Vector3d p = Eigen::Vector3d(at[0], at[1], at[2]) * (size_mm / fine);
            out.pair.polycube.push_back(p);
            out.pair.shape.push_back(bend(p));
        }
        return entry->second;
    };
    constexpr std::array<std::array<int, 3>, 6> kOrders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (const Voxel& voxel : voxels) {
        for (int i = 0; i < fine * fine * fine; ++i) {
            const Voxel low{voxel[0] * fine + i / (fine * fine), voxel[1] * fine + i / fine % fine,
                            voxel[2] * fine + i % fine};
            for (std::size_t o = 0; o < kOrders.size(); ++o) {
                Voxel at = low;
                decomp::tets::Tet tet{point(at), 0, 0, 0};
                for (std::size_t k = 0; k < 3; ++k) {
                    ++at.at(static_cast<std::size_t>(kOrders.at(o).at(k)));
                    tet.at(k + 1) = point(at);
                }
                if (o >= 3) {
                    std::swap(tet[2], tet[3]);
                }
                out.pair.tets.push_back(tet);
            }
        }
    }
    std::map<std::array<std::uint32_t, 3>, decomp::mesh::Triangle> faces;
    for (const auto& t : out.pair.tets) {
        for (const decomp::mesh::Triangle& f :
             std::array<decomp::mesh::Triangle, 4>{{{t[0], t[2], t[1]},
                                                    {t[0], t[1], t[3]},
                                                    {t[1], t[2], t[3]},
                                                    {t[0], t[3], t[2]}}}) {
            std::array<std::uint32_t, 3> key{f[0], f[1], f[2]};
            std::sort(key.begin(), key.end());
            if (!faces.emplace(key, f).second) {
                faces.erase(key);
            }
        }
    }
    out.surface.points = out.pair.shape;
    for (const auto& [key, face] : faces) {
        out.surface.triangles.push_back(face);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<double>& planes = out.lattice.planes.at(axis);
        for (const Voxel& voxel : voxels) {
            planes.push_back(voxel.at(axis) * size_mm);
            planes.push_back((voxel.at(axis) + 1) * size_mm);
        }
        std::sort(planes.begin(), planes.end());
        planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
    }
    for (const auto& t : out.pair.tets) {
        const Eigen::Vector3d& o = out.pair.shape[t[0]];
        const Eigen::Vector3d a = out.pair.shape[t[1]] - o;
        const Eigen::Vector3d b = out.pair.shape[t[2]] - o;
        const Eigen::Vector3d c = out.pair.shape[t[3]] - o;
        out.volume_mm3 += (a.y() * b.z() - a.z() * b.y()) * c.x() / 6 +
                          (a.z() * b.x() - a.x() * b.z()) * c.y() / 6 +
                          (a.x() * b.y() - a.y() * b.x()) * c.z() / 6;
    }
    return out;
}

}  // namespace tests
