// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Inside the room: a closed surface with what labelling asks of it again and again.
namespace decomp::labels {

struct Facets {
    std::vector<Eigen::Vector3d> points;
    std::vector<mesh::Triangle> corners;
    /// Across the edge from corner k to corner k + 1.
    std::vector<std::array<std::uint32_t, 3>> neighbours;
    std::vector<Eigen::Vector3d> centres;
    std::vector<Eigen::Vector3d> normals;  ///< unit length; zero for a facet without area
    std::vector<double> areas;             ///< mm^2
    double area = 0;                       ///< mm^2, the sum
    double diagonal = 0;                   ///< mm, of the bounds
    /// mm: the edge length at which 3000 equilateral triangles cover the surface. The unit of all
    /// radii here, so that they mean the same on finer and on coarser surfaces.
    double unit = 0;

    [[nodiscard]] std::size_t count() const { return corners.size(); }

    /// The facets around a vertex, ascending.
    [[nodiscard]] std::span<const std::uint32_t> around(std::uint32_t vertex) const {
        return {fans.data() + fan_begin[vertex], fans.data() + fan_begin[vertex + 1]};
    }

    [[nodiscard]] double edge_length(std::uint32_t facet, std::size_t k) const {
        const auto& t = corners[facet];
        return (points[t.at(k)] - points[t.at((k + 1) % 3)]).norm();
    }

    /// The facets around all vertices in a row, and where those of each vertex begin.
    std::vector<std::uint32_t> fans;
    std::vector<std::uint32_t> fan_begin;
};

/// @error labels.surface  the surface is empty, or not closed and manifold by its edges
[[nodiscard]] Result<Facets> facets_of(const mesh::TriMesh& surface);

/// Facets within `rings` steps across edges of the seeds, seeds first, then ring by ring.
[[nodiscard]] std::vector<std::uint32_t> grown(const Facets& facets,
                                               std::span<const std::uint32_t> seeds, int rings);

/// Facets that a walk over neighbours reaches from the seeds without leaving the ball about
/// `centre` by their centres; the seeds first.
[[nodiscard]] std::vector<std::uint32_t> within(const Facets& facets,
                                                std::span<const std::uint32_t> seeds,
                                                const Eigen::Vector3d& centre, double radius);

}  // namespace decomp::labels
