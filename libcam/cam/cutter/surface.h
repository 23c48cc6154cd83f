// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cam::cutter {

/// What a tool can touch from above of a closed, outward mesh, sorted into a grid over XY. +Z
/// points to the spindle.
class Surface {
  public:
    /// An edge in plan: from a point, along a unit direction.
    struct Edge {
        double x = 0;
        double y = 0;
        double z = 0;
        double along_x = 0;
        double along_y = 0;
        double length = 0;  ///< in plan
        double slope = 0;   ///< z per length in plan
        double sine = 0;    ///< of the slope's angle
    };

    /// A facet that does not face down, with those of its edges that no facet before it has and
    /// that a tool can rest on: in a valley it rests on the facets beside it first.
    struct Facet {
        std::array<double, 6> corners{};  ///< x, y of each, counter-clockwise
        double z0 = 0;  ///< of the first corner; the plane rises from there by gx, gy
        double gx = 0;
        double gy = 0;
        double stretch = 1;          ///< sqrt(1 + steepness^2)
        double steepness = 0;        ///< length of the gradient
        std::array<float, 4> box{};  ///< min x, min y, max x, max y; rounded outwards
        std::uint32_t first_edge = 0;
        std::uint32_t edges = 0;
        bool has_plane = false;  ///< not a wall
    };

    /// A facet in a cell; the cell's are sorted by falling top.
    struct Entry {
        double top = 0;  ///< no point of the facet in this cell is higher
        std::uint32_t facet = 0;
    };

    /// O(n log n).
    explicit Surface(const decomp::mesh::TriMesh& mesh);

    [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }

    [[nodiscard]] double cell_mm() const { return cell_; }

    [[nodiscard]] int columns() const { return columns_; }

    [[nodiscard]] int rows() const { return rows_; }

    [[nodiscard]] const Facet& facet(std::uint32_t index) const { return facets_[index]; }

    [[nodiscard]] std::size_t facets() const { return facets_.size(); }

    [[nodiscard]] std::span<const Edge> edges_of(const Facet& facet) const {
        return std::span(edges_).subspan(facet.first_edge, facet.edges);
    }

    /// Facets that touch a cell.
    [[nodiscard]] std::span<const Entry> in_cell(int column, int row) const {
        const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                          static_cast<std::size_t>(column);
        return std::span(entries_).subspan(starts_[cell], starts_[cell + 1] - starts_[cell]);
    }

  private:
    void collect_facets(const decomp::mesh::TriMesh& mesh);
    void add_edge(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
    void sort_into_cells();

    Eigen::AlignedBox3d bounds_;
    double cell_ = 1;
    int columns_ = 0;
    int rows_ = 0;
    std::vector<Facet> facets_;
    std::vector<double> facet_tops_;
    std::vector<Edge> edges_;
    std::vector<Entry> entries_;
    std::vector<std::size_t> starts_;
};

}  // namespace cam::cutter
