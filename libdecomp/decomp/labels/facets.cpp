// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/facets.h"

#include "decomp/mesh/measure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace decomp::labels {

namespace {

constexpr double kReferenceTriangles = 3000;

struct DirectedEdge {
    std::uint32_t from, to, facet;
    std::uint8_t k;
};

bool link_neighbours(Facets& facets) {
    std::vector<DirectedEdge> edges;
    edges.reserve(3 * facets.count());
    for (std::uint32_t f = 0; f < facets.count(); ++f) {
        for (std::uint8_t k = 0; k < 3; ++k) {
            edges.push_back({facets.corners[f].at(k), facets.corners[f].at((k + 1U) % 3U), f, k});
        }
    }
    const auto key = [](std::uint32_t a, std::uint32_t b) {
        return (static_cast<std::uint64_t>(a) << 32U) | b;
    };
    std::sort(edges.begin(), edges.end(), [&](const DirectedEdge& a, const DirectedEdge& b) {
        return key(a.from, a.to) < key(b.from, b.to);
    });
    facets.neighbours.resize(facets.count());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto& edge = edges[i];
        const std::uint64_t wanted = key(edge.to, edge.from);
        const auto twin = std::lower_bound(
            edges.begin(), edges.end(), wanted,
            [&](const DirectedEdge& e, std::uint64_t value) { return key(e.from, e.to) < value; });
        const bool twice = i + 1 < edges.size() &&
                           key(edges[i + 1].from, edges[i + 1].to) == key(edge.from, edge.to);
        if (twice || edge.from == edge.to || twin == edges.end() ||
            key(twin->from, twin->to) != wanted) {
            return false;
        }
        facets.neighbours[edge.facet].at(edge.k) = twin->facet;
    }
    return true;
}

void link_vertices(Facets& facets) {
    facets.fan_begin.assign(facets.points.size() + 1, 0);
    for (const auto& t : facets.corners) {
        for (const auto v : t) {
            ++facets.fan_begin[v + 1];
        }
    }
    for (std::size_t v = 0; v < facets.points.size(); ++v) {
        facets.fan_begin[v + 1] += facets.fan_begin[v];
    }
    facets.fans.resize(3 * facets.count());
    std::vector<std::uint32_t> next(facets.fan_begin.begin(), facets.fan_begin.end() - 1);
    for (std::uint32_t f = 0; f < facets.count(); ++f) {
        for (const auto v : facets.corners[f]) {
            facets.fans[next[v]++] = f;
        }
    }
}

/// Appends the facets across the edges of one that are not in yet.
void append_neighbours(const Facets& facets, std::uint32_t facet, std::vector<bool>& in,
                       std::vector<std::uint32_t>& out) {
    for (const auto g : facets.neighbours[facet]) {
        if (!in[g]) {
            in[g] = true;
            out.push_back(g);
        }
    }
}

}  // namespace

Result<Facets> facets_of(const mesh::TriMesh& surface) {
    Facets facets;
    facets.points = surface.points;
    facets.corners = surface.triangles;
    if (facets.corners.empty() || !link_neighbours(facets)) {
        return fail("labels.surface", "the surface is empty, open or no manifold", "",
                    "label a closed surface, as make_proxy gives it");
    }
    link_vertices(facets);
    for (std::uint32_t f = 0; f < facets.count(); ++f) {
        const Eigen::Vector3d n = mesh::double_area_normal(surface, f);
        const double length = n.norm();
        const auto& t = facets.corners[f];
        facets.areas.push_back(length / 2);
        facets.area += length / 2;
        facets.normals.push_back(length > 0 ? Eigen::Vector3d(n / length)
                                            : Eigen::Vector3d::Zero());
        facets.centres.emplace_back(
            (facets.points[t[0]] + facets.points[t[1]] + facets.points[t[2]]) / 3);
    }
    facets.diagonal = mesh::diagonal_mm(surface);
    facets.unit = std::sqrt(4 * facets.area / (std::sqrt(3.0) * kReferenceTriangles));
    if (!(facets.area > 0)) {
        return fail("labels.surface", "the surface has no area", "",
                    "label a closed surface, as make_proxy gives it");
    }
    return facets;
}

std::vector<std::uint32_t> grown(const Facets& facets, std::span<const std::uint32_t> seeds,
                                 int rings) {
    std::vector<std::uint32_t> out(seeds.begin(), seeds.end());
    std::vector<bool> in(facets.count(), false);
    for (const auto f : out) {
        in[f] = true;
    }
    std::size_t begin = 0;
    for (int ring = 0; ring < rings; ++ring) {
        const std::size_t end = out.size();
        for (; begin < end; ++begin) {
            append_neighbours(facets, out[begin], in, out);
        }
    }
    return out;
}

std::vector<std::uint32_t> within(const Facets& facets, std::span<const std::uint32_t> seeds,
                                  const Eigen::Vector3d& centre, double radius) {
    std::vector<std::uint32_t> out(seeds.begin(), seeds.end());
    std::vector<bool> in(facets.count(), false);
    for (const auto f : out) {
        in[f] = true;
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        for (const auto g : facets.neighbours[out[i]]) {
            if (!in[g] && (facets.centres[g] - centre).squaredNorm() < radius * radius) {
                in[g] = true;
                out.push_back(g);
            }
        }
    }
    return out;
}

}  // namespace decomp::labels
