// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/check.h"
#include "decomp/repair/edges.h"
#include "decomp/repair/soup.h"

#include <Eigen/Core>

#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace decomp::repair {

namespace {

constexpr double kEdgeShare = 0.3;  // below a half, so that the ends of an edge never meet

/// How far each point may be moved: 0 off the border.
std::vector<double> reach_of_points(const mesh::TriMesh& mesh, double reach_mm) {
    std::vector<double> shortest(mesh.points.size(), std::numeric_limits<double>::infinity());
    const std::vector<Side> sides = sorted_sides(mesh);
    for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
        if (end - begin == 1) {
            const double length =
                (mesh.points[sides[begin].low] - mesh.points[sides[begin].high]).norm();
            for (const std::uint32_t point : {sides[begin].low, sides[begin].high}) {
                shortest[point] = std::min(shortest[point], length);
            }
        }
    });
    for (double& reach : shortest) {
        reach = reach == std::numeric_limits<double>::infinity()
                    ? 0
                    : std::min(reach_mm, kEdgeShare * reach);
    }
    return shortest;
}

using Cell = std::tuple<long, long, long>;
using Grid = std::map<Cell, std::vector<std::uint32_t>>;

Cell cell_of(const Eigen::Vector3d& point, double size) {
    return {std::lround(std::floor(point.x() / size)), std::lround(std::floor(point.y() / size)),
            std::lround(std::floor(point.z() / size))};
}

/// The nearest point of the grid within its own reach and that of point i, from the cells around;
/// i where there is none.
std::uint32_t nearest_in_reach(const mesh::TriMesh& mesh, const std::vector<double>& reach,
                               const Grid& grid, const Cell& cell, std::uint32_t i) {
    const auto [x, y, z] = cell;
    std::uint32_t target = i;
    double nearest = reach[i];
    for (long n = 0; n < 27; ++n) {
        const auto found = grid.find({x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1});
        if (found == grid.end()) {
            continue;
        }
        for (const std::uint32_t other : found->second) {
            const double distance = (mesh.points[other] - mesh.points[i]).norm();
            if (distance <= std::min(nearest, reach[other])) {
                nearest = distance;
                target = other;
            }
        }
    }
    return target;
}

/// For each point the border point of lower index that it merges into, or itself.
std::vector<std::uint32_t> merge_targets(const mesh::TriMesh& mesh, double reach_mm) {
    const std::vector<double> reach = reach_of_points(mesh, reach_mm);
    std::vector<std::uint32_t> target(mesh.points.size());
    std::iota(target.begin(), target.end(), 0U);
    Grid grid;
    for (std::uint32_t i = 0; i < mesh.points.size(); ++i) {
        if (reach[i] == 0) {
            continue;
        }
        const Cell cell = cell_of(mesh.points[i] - mesh.points[0], reach_mm);
        target[i] = nearest_in_reach(mesh, reach, grid, cell, i);
        if (target[i] == i) {
            grid[cell].push_back(i);
        }
    }
    return target;
}

}  // namespace

NearMerge merge_near_border(mesh::TriMesh& mesh, double reach_mm) {
    NearMerge merge;
    if (!(reach_mm > 0)) {
        return merge;
    }
    const std::vector<std::uint32_t> target = merge_targets(mesh, reach_mm);
    mesh::TriMesh merged = mesh;
    for (std::uint32_t i = 0; i < target.size(); ++i) {
        if (target[i] != i) {
            ++merge.points;
            merge.farthest_mm =
                std::max(merge.farthest_mm, (mesh.points[target[i]] - mesh.points[i]).norm());
        }
    }
    for (auto& triangle : merged.triangles) {
        for (auto& corner : triangle) {
            corner = target[corner];
        }
    }
    drop_degenerate(merged);
    drop_duplicates(merged);
    const mesh::TopologyReport before = mesh::check_topology(mesh);
    const mesh::TopologyReport after = mesh::check_topology(merged);
    if (merge.points == 0 || after.border_edges >= before.border_edges ||
        after.non_manifold_edges > before.non_manifold_edges) {
        return {};
    }
    mesh = std::move(merged);
    return merge;
}

}  // namespace decomp::repair
