// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace cam::fdm {

/// A point on a region's boundary.
struct BoundaryPoint {
    std::size_t loop = 0;
    std::size_t edge = 0;  ///< from vertex `edge` to the next
    double on_edge = 0;    ///< 0..1
    Eigen::Vector2d at_mm = Eigen::Vector2d::Zero();
};

/// A boundary point met by a straight way, and how far along the way.
struct Meeting {
    BoundaryPoint point;
    double along = 0;  ///< 0..1
};

/// The edges of a region's boundary in square cells: what is near is found without looking at the
/// rest. Memory O(edges + cells), queries O(cells passed).
class EdgeGrid {
  public:
    explicit EdgeGrid(const polygon::Paths& region);

    [[nodiscard]] bool empty() const { return loops_.empty(); }

    [[nodiscard]] const std::vector<std::vector<Eigen::Vector2d>>& loops() const { return loops_; }

    /// Whether a straight way meets the boundary.
    [[nodiscard]] bool crosses(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

    /// Where a straight way meets the boundary, in the order of the way.
    [[nodiscard]] std::vector<Meeting> meetings(const Eigen::Vector2d& from,
                                                const Eigen::Vector2d& to) const;

    /// Even-odd.
    [[nodiscard]] bool contains(const Eigen::Vector2d& point) const;

    /// The boundary point nearest to `point` within `reach_mm`.
    [[nodiscard]] std::optional<BoundaryPoint> nearest(const Eigen::Vector2d& point,
                                                       double reach_mm) const;

  private:
    struct Edge {
        std::uint32_t loop = 0;
        std::uint32_t index = 0;
    };

    using Ends = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

    [[nodiscard]] Ends ends(const Edge& edge) const;
    [[nodiscard]] int column(double x) const;
    [[nodiscard]] int row(double y) const;
    template <class Visit>
    void visit_cells(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                     const Visit& visit) const;
    template <class Body>
    void for_each_passing(const Body& body) const;
    template <class Visit>
    void visit_edges(int column, int row, const Visit& visit) const;

    std::vector<std::vector<Eigen::Vector2d>> loops_;
    Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
    double cell_mm_ = 1;
    int columns_ = 0;
    int rows_ = 0;
    std::vector<std::uint32_t> first_;  ///< of each cell, one more than there are cells
    std::vector<Edge> edges_;
};

}  // namespace cam::fdm
