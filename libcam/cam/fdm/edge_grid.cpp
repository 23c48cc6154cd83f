// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/edge_grid.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;

constexpr double kLeastCellMm = 0.5;
constexpr int kMostCells = 256;  // along one side

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Where the way from -> to meets the edge a -> b; half-open in the edge, so that a way through a
/// vertex meets one of its two edges.
std::optional<std::pair<double, double>> meeting(const Vector2d& from, const Vector2d& to,
                                                 const Vector2d& a, const Vector2d& b) {
    const Vector2d along = to - from;
    const double side_a = cross(along, a - from);
    const double side_b = cross(along, b - from);
    if ((side_a >= 0) == (side_b >= 0)) {
        return std::nullopt;
    }
    const double on_edge = side_a / (side_a - side_b);
    const Vector2d p = a + on_edge * (b - a);
    const double t = (p - from).dot(along) / along.squaredNorm();
    if (t < 0 || t > 1) {
        return std::nullopt;
    }
    return std::pair(t, on_edge);
}

/// The nearest boundary point so far. Ties are broken by position in the region, not by cell.
struct Nearest {
    double least;  ///< squared distance
    std::optional<BoundaryPoint> best;

    void take(const BoundaryPoint& point, double distance2) {
        const bool same = best && distance2 == least;
        const bool earlier =
            same && std::pair(point.loop, point.edge) < std::pair(best->loop, best->edge);
        if (distance2 < least || earlier) {
            least = distance2;
            best = point;
        }
    }
};

}  // namespace

EdgeGrid::EdgeGrid(const polygon::Paths& region) {
    Vector2d high = Vector2d::Zero();
    std::size_t count = 0;
    for (const auto& path : region) {
        auto& loop = loops_.emplace_back();
        loop.reserve(path.size());
        for (const auto& p : path) {
            const Vector2d at = polygon::to_mm(p);
            low_ = count == 0 ? at : Vector2d(low_.cwiseMin(at));
            high = count == 0 ? at : Vector2d(high.cwiseMax(at));
            loop.push_back(at);
            ++count;
        }
    }
    if (count == 0) {
        return;
    }
    const double extent = (high - low_).maxCoeff();
    const double wanted = extent / std::sqrt(static_cast<double>(count) + 1);
    cell_mm_ = std::max({kLeastCellMm, wanted, extent / kMostCells});
    columns_ = static_cast<int>((high.x() - low_.x()) / cell_mm_) + 1;
    rows_ = static_cast<int>((high.y() - low_.y()) / cell_mm_) + 1;
    // Counted first, then filled in: two passes over the same cells.
    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for_each_passing([&](std::size_t cell, const Edge&) { ++first_[cell + 1]; });
    for (std::size_t c = 0; c + 1 < first_.size(); ++c) {
        first_[c + 1] += first_[c];
    }
    edges_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for_each_passing([&](std::size_t cell, const Edge& edge) { edges_[next[cell]++] = edge; });
}

EdgeGrid::Ends EdgeGrid::ends(const Edge& edge) const {
    const auto& loop = loops_[edge.loop];
    return {loop[edge.index], loop[edge.index + 1 == loop.size() ? 0 : edge.index + 1]};
}

int EdgeGrid::column(double x) const {
    return std::clamp(static_cast<int>(std::floor((x - low_.x()) / cell_mm_)), 0, columns_ - 1);
}

int EdgeGrid::row(double y) const {
    return std::clamp(static_cast<int>(std::floor((y - low_.y()) / cell_mm_)), 0, rows_ - 1);
}

/// Every cell that a segment passes, and on slanted ones a few beside: row by row. Ends when
/// `visit` says false.
template <class Visit>
void EdgeGrid::visit_cells(const Vector2d& from, const Vector2d& to, const Visit& visit) const {
    constexpr double kSlackMm = 1e-6;
    const Vector2d& bottom = from.y() <= to.y() ? from : to;
    const Vector2d& top = from.y() <= to.y() ? to : from;
    const int j0 = row(bottom.y() - kSlackMm);
    const int j1 = row(top.y() + kSlackMm);
    const double rise = top.y() - bottom.y();
    for (int j = j0; j <= j1; ++j) {
        const double y0 = low_.y() + j * cell_mm_;
        // Of the outermost rows everything beyond belongs to them, since row() clamps.
        const double t0 = j == j0 || rise <= 0 ? 0 : std::clamp((y0 - bottom.y()) / rise, 0.0, 1.0);
        const double t1 =
            j == j1 || rise <= 0 ? 1 : std::clamp((y0 + cell_mm_ - bottom.y()) / rise, 0.0, 1.0);
        const double xa = bottom.x() + t0 * (top.x() - bottom.x());
        const double xb = bottom.x() + t1 * (top.x() - bottom.x());
        const int i1 = column(std::max(xa, xb) + kSlackMm);
        for (int i = column(std::min(xa, xb) - kSlackMm); i <= i1; ++i) {
            if (!visit(i, j)) {
                return;
            }
        }
    }
}

/// Every edge with each cell that it passes.
template <class Body>
void EdgeGrid::for_each_passing(const Body& body) const {
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
        for (std::uint32_t e = 0; e < loops_[l].size(); ++e) {
            const auto [a, b] = ends({l, e});
            visit_cells(a, b, [&](int i, int j) {
                body(static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                         static_cast<std::size_t>(i),
                     Edge{l, e});
                return true;
            });
        }
    }
}

template <class Visit>
void EdgeGrid::visit_edges(int column, int row, const Visit& visit) const {
    const std::size_t cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                             static_cast<std::size_t>(column);
    for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
        visit(edges_[k]);
    }
}

bool EdgeGrid::crosses(const Vector2d& from, const Vector2d& to) const {
    bool found = false;
    if (!empty()) {
        visit_cells(from, to, [&](int i, int j) {
            visit_edges(i, j, [&](const Edge& edge) {
                const auto [a, b] = ends(edge);
                found = found || meeting(from, to, a, b);
            });
            return !found;
        });
    }
    return found;
}

std::vector<Meeting> EdgeGrid::meetings(const Vector2d& from, const Vector2d& to) const {
    std::vector<Meeting> out;
    if (empty()) {
        return out;
    }
    visit_cells(from, to, [&](int i, int j) {
        visit_edges(i, j, [&](const Edge& edge) {
            const auto [a, b] = ends(edge);
            if (const auto met = meeting(from, to, a, b)) {
                out.push_back(
                    {{edge.loop, edge.index, met->second, a + met->second * (b - a)}, met->first});
            }
        });
        return true;
    });
    // An edge in several cells was met several times.
    const auto key = [](const Meeting& m) {
        return std::tuple(m.along, m.point.loop, m.point.edge);
    };
    std::sort(out.begin(), out.end(),
              [&](const Meeting& a, const Meeting& b) { return key(a) < key(b); });
    out.erase(std::unique(out.begin(), out.end(),
                          [&](const Meeting& a, const Meeting& b) { return key(a) == key(b); }),
              out.end());
    return out;
}

bool EdgeGrid::contains(const Vector2d& point) const {
    if (empty() || point.y() < low_.y() || point.y() > low_.y() + rows_ * cell_mm_) {
        return false;
    }
    const double far = low_.x() - cell_mm_;
    return meetings(point, {std::min(far, point.x() - cell_mm_), point.y()}).size() % 2 == 1;
}

std::optional<BoundaryPoint> EdgeGrid::nearest(const Vector2d& point, double reach_mm) const {
    if (empty()) {
        return std::nullopt;
    }
    Nearest found{reach_mm * reach_mm, std::nullopt};
    const int i1 = column(point.x() + reach_mm);
    const int j1 = row(point.y() + reach_mm);
    for (int j = row(point.y() - reach_mm); j <= j1; ++j) {
        for (int i = column(point.x() - reach_mm); i <= i1; ++i) {
            visit_edges(i, j, [&](const Edge& edge) {
                const auto [a, b] = ends(edge);
                const double length2 = (b - a).squaredNorm();
                const double t =
                    length2 > 0 ? std::clamp((point - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
                const Vector2d at = a + t * (b - a);
                found.take({edge.loop, edge.index, t, at}, (at - point).squaredNorm());
            });
        }
    }
    return found.best;
}

}  // namespace cam::fdm
