// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/check.h"

#include "decomp/mesh/measure.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace decomp::mesh {

namespace {

/// One side of a triangle, keyed by its undirected edge.
struct Side {
    std::uint64_t edge = 0;
    std::uint32_t triangle = 0;
    bool forward = false;  ///< runs from the lower to the higher index
};

std::vector<Side> sorted_sides(const TriMesh& mesh) {
    std::vector<Side> sides;
    sides.reserve(mesh.triangles.size() * 3);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t a = mesh.triangles[i].at(k);
            const std::uint64_t b = mesh.triangles[i].at((k + 1) % 3);
            if (a != b) {
                sides.push_back({std::min(a, b) << 32U | std::max(a, b), i, a < b});
            }
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) {
        return std::pair(l.edge, l.triangle) < std::pair(r.edge, r.triangle);
    });
    return sides;
}

/// Union-find with path halving.
class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }

    void unite(std::uint32_t a, std::uint32_t b) {
        parent_[std::max(find(a), find(b))] = std::min(find(a), find(b));
    }

  private:
    std::vector<std::uint32_t> parent_;
};

/// Corners of triangles as nodes: united where two triangles share an edge at that vertex. A vertex
/// is manifold when all its corners end in one set.
std::size_t count_non_manifold_vertices(const TriMesh& mesh, const std::vector<Side>& sides) {
    Sets corners(mesh.triangles.size() * 3);
    const auto corner_of = [&](std::uint32_t triangle, std::uint64_t vertex) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (mesh.triangles[triangle].at(k) == vertex) {
                return 3 * triangle + k;
            }
        }
        return 3 * triangle;
    };
    for (std::size_t i = 1; i < sides.size(); ++i) {
        if (sides[i].edge == sides[i - 1].edge) {
            for (const std::uint64_t vertex : {sides[i].edge >> 32U, sides[i].edge & 0xFFFFFFFFU}) {
                corners.unite(corner_of(sides[i].triangle, vertex),
                              corner_of(sides[i - 1].triangle, vertex));
            }
        }
    }
    std::vector<std::uint32_t> umbrellas(mesh.points.size(), 0);
    for (std::uint32_t i = 0; i < mesh.triangles.size() * 3; ++i) {
        umbrellas[mesh.triangles[i / 3].at(i % 3)] += corners.find(i) == i ? 1U : 0U;
    }
    return static_cast<std::size_t>(
        std::count_if(umbrellas.begin(), umbrellas.end(), [](auto n) { return n > 1; }));
}

}  // namespace

TopologyReport check_topology(const TriMesh& mesh) {
    TopologyReport report;
    const std::vector<Side> sides = sorted_sides(mesh);
    Sets triangles(mesh.triangles.size());
    std::size_t edges = 0;
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        std::size_t forward = 0;
        for (end = begin; end < sides.size() && sides[end].edge == sides[begin].edge; ++end) {
            forward += sides[end].forward ? 1U : 0U;
            triangles.unite(sides[begin].triangle, sides[end].triangle);
        }
        const std::size_t count = end - begin;
        ++edges;
        report.border_edges += count == 1 ? 1U : 0U;
        report.non_manifold_edges += count > 2 ? 1U : 0U;
        report.misoriented_edges += count == 2 && forward != 1 ? 1U : 0U;
    }
    std::vector<bool> used(mesh.points.size(), false);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        report.components += triangles.find(i) == i ? 1U : 0U;
        report.degenerate_triangles += double_area_normal(mesh, i).squaredNorm() == 0 ? 1U : 0U;
        for (const std::uint32_t corner : mesh.triangles[i]) {
            used[corner] = true;
        }
    }
    report.non_manifold_vertices = count_non_manifold_vertices(mesh, sides);
    report.euler_characteristic = static_cast<long>(std::count(used.begin(), used.end(), true)) -
                                  static_cast<long>(edges) +
                                  static_cast<long>(mesh.triangles.size());
    return report;
}

}  // namespace decomp::mesh
