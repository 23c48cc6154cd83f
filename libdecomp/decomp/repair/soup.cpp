// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/soup.h"

#include "decomp/mesh/measure.h"
#include "decomp/repair/edges.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace decomp::repair {

namespace {

constexpr std::uint32_t kUnset = std::numeric_limits<std::uint32_t>::max();

bool before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

/// The corners sorted, and whether sorting takes an even number of swaps.
struct CornerSet {
    mesh::Triangle corners{};
    bool even = false;
};

CornerSet corner_set(const mesh::Triangle& t) {
    mesh::Triangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    const auto lowest = static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
    return {sorted, t.at((lowest + 1) % 3) < t.at((lowest + 2) % 3)};
}

void compact_points(mesh::TriMesh& mesh) {
    std::vector<std::uint32_t> new_index(mesh.points.size(), kUnset);
    for (const auto& triangle : mesh.triangles) {
        for (const auto corner : triangle) {
            new_index[corner] = 0;
        }
    }
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (new_index[i] != kUnset) {
            mesh.points[kept] = mesh.points[i];
            new_index[i] = kept++;
        }
    }
    mesh.points.resize(kept);
    for (auto& triangle : mesh.triangles) {
        for (auto& corner : triangle) {
            corner = new_index[corner];
        }
    }
}

/// Two triangles that share an edge with nobody else.
struct Link {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    bool agree = false;  ///< they run along the edge in opposite senses
};

/// The links of triangle t are those from first[t] to first[t + 1].
struct Links {
    std::vector<Link> all;
    std::vector<std::size_t> first;
};

Links links_of_triangles(const mesh::TriMesh& mesh) {
    Links links;
    const std::vector<Side> sides = sorted_sides(mesh);
    for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
        if (end - begin == 2) {
            const Side& a = sides[begin];
            const Side& b = sides[begin + 1];
            links.all.push_back({a.triangle, b.triangle, a.forward != b.forward});
            links.all.push_back({b.triangle, a.triangle, a.forward != b.forward});
        }
    });
    std::sort(links.all.begin(), links.all.end(), [](const Link& l, const Link& r) {
        return std::tie(l.from, l.to) < std::tie(r.from, r.to);
    });
    links.first.assign(mesh.triangles.size() + 1, 0);
    for (const Link& link : links.all) {
        ++links.first[link.from + 1];
    }
    std::partial_sum(links.first.begin(), links.first.end(), links.first.begin());
    return links;
}

enum class Sense : std::uint8_t { Unknown, Keep, Turn };

/// Spreads the sense of a seed over all triangles that are linked with it, and lists these.
void spread_sense(const Links& links, std::uint32_t seed, std::vector<Sense>& sense,
                  std::vector<std::uint32_t>& reached) {
    sense[seed] = Sense::Keep;
    reached.assign(1, seed);
    for (std::size_t head = 0; head < reached.size(); ++head) {
        const std::uint32_t triangle = reached[head];
        for (std::size_t l = links.first[triangle]; l < links.first[triangle + 1]; ++l) {
            const Link& link = links.all[l];
            if (sense[link.to] == Sense::Unknown) {
                const bool keep = (sense[triangle] == Sense::Keep) == link.agree;
                sense[link.to] = keep ? Sense::Keep : Sense::Turn;
                reached.push_back(link.to);
            }
        }
    }
}

}  // namespace

std::vector<std::uint32_t> first_of_equal_points(const mesh::TriMesh& mesh) {
    std::vector<std::uint32_t> order(mesh.points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return mesh.points[a] == mesh.points[b] ? a < b : before(mesh.points[a], mesh.points[b]);
    });
    std::vector<std::uint32_t> first(mesh.points.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && mesh.points[order[i]] == mesh.points[order[i - 1]];
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

std::size_t weld(mesh::TriMesh& mesh) {
    const std::vector<std::uint32_t> first = first_of_equal_points(mesh);
    std::size_t merged = 0;
    for (std::uint32_t i = 0; i < first.size(); ++i) {
        merged += first[i] != i ? 1U : 0U;
    }
    for (auto& triangle : mesh.triangles) {
        for (auto& corner : triangle) {
            corner = first[corner];
        }
    }
    compact_points(mesh);
    return merged;
}

std::size_t drop_degenerate(mesh::TriMesh& mesh) {
    const std::size_t dropped = std::erase_if(mesh.triangles, [](const mesh::Triangle& t) {
        return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    });
    compact_points(mesh);
    return dropped;
}

DroppedDuplicates drop_duplicates(mesh::TriMesh& mesh) {
    std::vector<CornerSet> sets;
    sets.reserve(mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) {
        sets.push_back(corner_set(triangle));
    }
    std::vector<std::uint32_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(sets[a].corners, a) < std::tie(sets[b].corners, b);
    });
    DroppedDuplicates dropped;
    std::vector<bool> keep(mesh.triangles.size(), true);
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        std::size_t even = 0;
        for (end = begin;
             end < order.size() && sets[order[end]].corners == sets[order[begin]].corners; ++end) {
            even += sets[order[end]].even ? 1U : 0U;
        }
        const std::size_t odd = end - begin - even;
        if (end - begin < 2) {
            continue;
        }
        // One of the majority's sense stays; equal numbers of both are a wall with solid, or
        // nothing, on both sides.
        bool stays = even != odd;
        for (std::size_t i = begin; i < end; ++i) {
            const bool of_majority = sets[order[i]].even == (even > odd);
            keep[order[i]] = stays && of_majority;
            stays = stays && !of_majority;
        }
        dropped.wall_pairs += std::min(even, odd);
        dropped.copies += even == odd ? 0 : std::max(even, odd) - std::min(even, odd) - 1;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (keep[i]) {
            mesh.triangles[kept++] = mesh.triangles[i];
        }
    }
    mesh.triangles.resize(kept);
    compact_points(mesh);
    return dropped;
}

std::size_t orient_consistently(mesh::TriMesh& mesh) {
    const Links links = links_of_triangles(mesh);
    std::vector<Sense> sense(mesh.triangles.size(), Sense::Unknown);
    std::size_t turned = 0;
    std::vector<std::uint32_t> reached;
    for (std::uint32_t seed = 0; seed < sense.size(); ++seed) {
        if (sense[seed] != Sense::Unknown) {
            continue;
        }
        spread_sense(links, seed, sense, reached);
        const auto to_turn = static_cast<std::size_t>(std::count_if(
            reached.begin(), reached.end(), [&](auto t) { return sense[t] == Sense::Turn; }));
        const Sense minority = 2 * to_turn > reached.size() ? Sense::Keep : Sense::Turn;
        for (const std::uint32_t triangle : reached) {
            if (sense[triangle] == minority) {
                std::swap(mesh.triangles[triangle][1], mesh.triangles[triangle][2]);
                ++turned;
            }
        }
    }
    return turned;
}

Components components(const mesh::TriMesh& mesh) {
    Sets sets(mesh.triangles.size());
    const std::vector<Side> sides = sorted_sides(mesh);
    for (std::size_t i = 1; i < sides.size(); ++i) {
        if (sides[i].same_edge(sides[i - 1])) {
            sets.unite(sides[i].triangle, sides[i - 1].triangle);
        }
    }
    Components parts;
    parts.of_triangle.resize(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t root = sets.find(i);
        parts.of_triangle[i] =
            root == i ? static_cast<std::uint32_t>(parts.count++) : parts.of_triangle[root];
    }
    return parts;
}

mesh::TriMesh extract(const mesh::TriMesh& mesh, const Components& parts,
                      const std::vector<bool>& wanted) {
    mesh::TriMesh out;
    out.points = mesh.points;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (wanted[parts.of_triangle[i]]) {
            out.triangles.push_back(mesh.triangles[i]);
        }
    }
    compact_points(out);
    return out;
}

void append(mesh::TriMesh& mesh, const mesh::TriMesh& more) {
    const auto shift = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), more.points.begin(), more.points.end());
    for (const auto& t : more.triangles) {
        mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    }
}

void flip(mesh::TriMesh& mesh) {
    for (auto& triangle : mesh.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
}

}  // namespace decomp::repair
