// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/printed_heights.h"

#include <algorithm>
#include <cmath>

namespace cam::verify {
namespace {

constexpr double kMostCells = 4e6;
constexpr double kStill = 1e-12;

}  // namespace

PrintedHeights::PrintedHeights(const Eigen::Vector2d& min_mm, const Eigen::Vector2d& max_mm)
    : min_(min_mm) {
    const Eigen::Vector2d size = (max_mm - min_mm).cwiseMax(1.0).cwiseMin(1e5);
    cell_mm_ = std::max(cell_mm_, std::sqrt(size.prod() / kMostCells));
    columns_ = static_cast<int>(size.x() / cell_mm_) + 1;
    rows_ = static_cast<int>(size.y() / cell_mm_) + 1;
    top_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1e9F);
}

template <class Body>
void PrintedHeights::for_cells(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Body& body) const {
    // Clipped to the grid first: a move may go anywhere.
    double from = 0;
    double to = 1;
    const Eigen::Vector3d d = b - a;
    const Eigen::Vector2d size(columns_ * cell_mm_, rows_ * cell_mm_);
    for (int axis = 0; axis < 2; ++axis) {
        const double start = a[axis] - min_[axis];
        if (std::abs(d[axis]) < kStill) {
            if (start < 0 || start >= size[axis]) {
                return;
            }
            continue;
        }
        const double s = (0 - start) / d[axis];
        const double t = (size[axis] - start) / d[axis];
        from = std::max(from, std::min(s, t));
        to = std::min(to, std::max(s, t));
    }
    if (from > to) {
        return;
    }
    const int steps = static_cast<int>(std::ceil((to - from) * d.head<2>().norm() / cell_mm_)) + 1;
    for (int k = 0; k <= steps; ++k) {
        const double t = from + (to - from) * k / steps;
        const int i = std::clamp(static_cast<int>((a.x() + t * d.x() - min_.x()) / cell_mm_), 0,
                                 columns_ - 1);
        const int j =
            std::clamp(static_cast<int>((a.y() + t * d.y() - min_.y()) / cell_mm_), 0, rows_ - 1);
        body(static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(i),
             a.z() + t * d.z());
    }
}

double PrintedHeights::depth(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    double deepest = -1e9;
    for_cells(a, b,
              [&](std::size_t cell, double z) { deepest = std::max(deepest, top_[cell] - z); });
    return deepest;
}

void PrintedHeights::raise(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    for_cells(a, b, [&](std::size_t cell, double z) {
        top_[cell] = std::max(top_[cell], static_cast<float>(z));
    });
}

}  // namespace cam::verify
