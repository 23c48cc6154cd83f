// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/partition/outline.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <vector>

namespace decomp::partition {

Outline outline_of(const mesh::TriMesh& mesh, const part::Plane& plane) {
    std::vector<double> heights;
    heights.reserve(mesh.points.size());
    for (const Eigen::Vector3d& point : mesh.points) {
        heights.push_back(plane.normal.dot(point) - plane.offset_mm);
    }
    std::unordered_map<std::uint64_t, std::uint32_t> number;  // looked up only
    std::vector<std::uint32_t> parent;
    std::vector<Eigen::Vector3d> at;
    const auto crossing = [&](std::uint32_t a, std::uint32_t b) {
        const auto [low, high] = std::minmax(a, b);
        const auto [entry, is_new] = number.try_emplace((std::uint64_t{low} << 32U) | high,
                                                        static_cast<std::uint32_t>(at.size()));
        if (is_new) {
            const double t = heights[low] / (heights[low] - heights[high]);
            at.emplace_back(mesh.points[low] + t * (mesh.points[high] - mesh.points[low]));
            parent.push_back(static_cast<std::uint32_t>(parent.size()));
        }
        return entry->second;
    };
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) {
            i = parent[i] = parent[parent[i]];
        }
        return i;
    };
    Outline out;
    double doubled = 0;
    for (const mesh::Triangle& t : mesh.triangles) {
        std::uint32_t into = 0;
        std::uint32_t out_of = 0;
        int crossings = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t.at(k);
            const std::uint32_t b = t.at((k + 1) % 3);
            if ((heights[a] >= 0) != (heights[b] >= 0)) {
                (heights[a] >= 0 ? out_of : into) = crossing(a, b);
                ++crossings;
            }
        }
        if (crossings == 2) {
            doubled += plane.normal.dot((at[out_of] - at.front()).cross(at[into] - at.front()));
            parent[root(out_of)] = root(into);
        }
    }
    for (std::uint32_t i = 0; i < parent.size(); ++i) {
        out.curves += root(i) == i ? 1 : 0;
    }
    out.area_mm2 = std::abs(doubled) / 2;
    return out;
}

}  // namespace decomp::partition
