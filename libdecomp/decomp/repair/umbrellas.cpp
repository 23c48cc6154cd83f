// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/edges.h"
#include "decomp/repair/soup.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace decomp::repair {

namespace {

constexpr std::uint32_t kUnset = std::numeric_limits<std::uint32_t>::max();
constexpr int kMostHalvings = 8;

/// Angle of the triangle of a side about its edge, from the lower to the higher point,
/// right-handed.
double angle_about_edge(const mesh::TriMesh& mesh, const Side& side, const Eigen::Vector3d& u,
                        const Eigen::Vector3d& v) {
    const std::uint32_t apex = mesh.triangles[side.triangle].at((side.k + 2U) % 3);
    const Eigen::Vector3d d = mesh.points[apex] - mesh.points[side.low];
    return std::atan2(d.dot(v), d.dot(u));
}

using SidePair = std::pair<Side, Side>;

/// Pairs the sides of an edge so that each pair encloses solid: going round, a triangle that runs
/// the edge backward has solid behind it and the next forward one ends it. Pairs nest like
/// brackets; what finds no partner stays alone.
void pair_around_edge(const mesh::TriMesh& mesh, const Side* begin, const Side* end,
                      std::vector<SidePair>& pairs) {
    const Eigen::Vector3d axis = (mesh.points[begin->high] - mesh.points[begin->low]).normalized();
    const Eigen::Vector3d u = axis.unitOrthogonal();
    const Eigen::Vector3d v = axis.cross(u);
    std::vector<std::pair<double, Side>> round;
    for (const Side* side = begin; side != end; ++side) {
        round.emplace_back(angle_about_edge(mesh, *side, u, v), *side);
    }
    std::sort(round.begin(), round.end());
    std::vector<bool> used(round.size(), false);
    std::vector<std::size_t> open_index;
    for (std::size_t step = 0; step < 2 * round.size(); ++step) {
        const std::size_t i = step % round.size();
        if (used[i]) {
            continue;
        }
        const bool first_time = step < round.size();
        if (!round[i].second.forward) {
            if (first_time) {
                open_index.push_back(i);
            }
        } else if (!open_index.empty()) {
            pairs.emplace_back(round[open_index.back()].second, round[i].second);
            used[i] = true;
            used[open_index.back()] = true;
            open_index.pop_back();
        }
    }
}

/// Which sides lie against each other, after pairing at edges with more than two triangles.
std::vector<SidePair> adjacent_sides(const mesh::TriMesh& mesh, const std::vector<Side>& sides) {
    std::vector<SidePair> pairs;
    pairs.reserve(sides.size() / 2);
    for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
        if (end - begin == 2) {
            pairs.emplace_back(sides[begin], sides[begin + 1]);
        } else if (end - begin > 2) {
            pair_around_edge(mesh, &sides[begin], &sides[begin] + (end - begin), pairs);
        }
    });
    return pairs;
}

std::uint32_t corner_at(const mesh::TriMesh& mesh, std::uint32_t triangle, std::uint32_t point) {
    for (std::uint32_t k = 0; k < 3; ++k) {
        if (mesh.triangles[triangle].at(k) == point) {
            return 3 * triangle + k;
        }
    }
    return 3 * triangle;
}

/// Gives every umbrella a point of its own; the first keeps the old one. Returns the number of new
/// points.
std::size_t split_points(mesh::TriMesh& mesh) {
    Sets umbrellas(mesh.triangles.size() * 3);
    for (const auto& [a, b] : adjacent_sides(mesh, sorted_sides(mesh))) {
        for (const std::uint32_t point : {a.low, a.high}) {
            umbrellas.unite(corner_at(mesh, a.triangle, point), corner_at(mesh, b.triangle, point));
        }
    }
    std::vector<bool> taken(mesh.points.size(), false);
    std::vector<std::uint32_t> point_of(mesh.triangles.size() * 3, kUnset);
    std::size_t added = 0;
    for (std::uint32_t corner = 0; corner < point_of.size(); ++corner) {
        const std::uint32_t umbrella = umbrellas.find(corner);
        std::uint32_t& point = mesh.triangles[corner / 3].at(corner % 3);
        if (point_of[umbrella] == kUnset) {
            point_of[umbrella] = point;
            if (taken[point]) {
                point_of[umbrella] = static_cast<std::uint32_t>(mesh.points.size());
                mesh.points.push_back(mesh.points[point]);
                taken.push_back(true);
                ++added;
            }
            taken[point] = true;
        }
        point = point_of[umbrella];
    }
    return added;
}

/// Halves edges with an even number of sides above two, at most one of each triangle; the halves
/// fall apart when their new middle point is split. Returns the number of edges halved.
std::size_t halve_crowded_edges(mesh::TriMesh& mesh) {
    const std::vector<Side> sides = sorted_sides(mesh);
    std::vector<bool> busy(mesh.triangles.size(), false);
    std::size_t halved = 0;
    for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
        bool free = end - begin > 2 && (end - begin) % 2 == 0;
        for (std::size_t i = begin; i < end; ++i) {
            free = free && !busy[sides[i].triangle];
        }
        if (!free) {
            return;
        }
        const auto middle = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.emplace_back((mesh.points[sides[begin].low] + mesh.points[sides[begin].high]) /
                                 2);
        for (std::size_t i = begin; i < end; ++i) {
            busy[sides[i].triangle] = true;
            mesh::Triangle second = mesh.triangles[sides[i].triangle];
            second.at(sides[i].k) = middle;
            mesh.triangles[sides[i].triangle].at((sides[i].k + 1U) % 3) = middle;
            mesh.triangles.push_back(second);
        }
        ++halved;
    });
    return halved;
}

}  // namespace

std::size_t split_non_manifold(mesh::TriMesh& mesh) {
    std::size_t added = split_points(mesh);
    for (int round = 0; round < kMostHalvings; ++round) {
        const std::size_t halved = halve_crowded_edges(mesh);
        if (halved == 0) {
            break;
        }
        added += halved + split_points(mesh);
    }
    return added;
}

}  // namespace decomp::repair
