// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/partition/locate.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace decomp::partition {

namespace {

constexpr double kMostPerSide = 256;
constexpr double kNoExtent = 1e-300;

}  // namespace

Locator::Locator(std::vector<const mesh::TriMesh*> solids) {
    Eigen::AlignedBox3d bounds;
    for (std::size_t i = 0; i < solids.size(); ++i) {
        for (const mesh::Triangle& t : solids[i]->triangles) {
            facets_.push_back({solids[i]->points[t[0]], solids[i]->points[t[1]],
                               solids[i]->points[t[2]], static_cast<int>(i)});
            for (const std::uint32_t corner : t) {
                bounds.extend(solids[i]->points[corner]);
            }
        }
    }
    low_ = bounds.min();
    high_ = bounds.max();
    side_ = static_cast<std::size_t>(
        std::clamp(std::sqrt(static_cast<double>(facets_.size())), 1.0, kMostPerSide));
    grid_.resize(side_ * side_);
    for (std::uint32_t i = 0; i < facets_.size(); ++i) {
        const Facet& f = facets_[i];
        const auto [x0, x1] = std::minmax({f.a.x(), f.b.x(), f.c.x()});
        const auto [y0, y1] = std::minmax({f.a.y(), f.b.y(), f.c.y()});
        for (std::size_t x = column(x0); x <= column(x1); ++x) {
            for (std::size_t y = row(y0); y <= row(y1); ++y) {
                grid_[x * side_ + y].push_back(i);
            }
        }
    }
}

std::size_t Locator::column(double x) const {
    const double share = (x - low_.x()) / std::max(high_.x() - low_.x(), kNoExtent);
    return static_cast<std::size_t>(
        std::clamp(share * static_cast<double>(side_), 0.0, static_cast<double>(side_ - 1)));
}

std::size_t Locator::row(double y) const {
    const double share = (y - low_.y()) / std::max(high_.y() - low_.y(), kNoExtent);
    return static_cast<std::size_t>(
        std::clamp(share * static_cast<double>(side_), 0.0, static_cast<double>(side_ - 1)));
}

int Locator::locate(const Eigen::Vector3d& point) const {
    if ((point.array() < low_.array()).any() || (point.array() > high_.array()).any()) {
        return -1;
    }
    // The first surface above: facing up, it is the roof over the point. Two solids that share it
    // have one facet each there, and the one that faces up counts.
    double nearest = std::numeric_limits<double>::infinity();
    int solid = -1;
    for (const std::uint32_t index : grid_[column(point.x()) * side_ + row(point.y())]) {
        const Facet& f = facets_[index];
        const auto cross = [](const Eigen::Vector3d& o, const Eigen::Vector3d& p,
                              const Eigen::Vector3d& q) {
            return (p.x() - o.x()) * (q.y() - o.y()) - (p.y() - o.y()) * (q.x() - o.x());
        };
        const double whole = cross(f.a, f.b, f.c);
        const double u = cross(point, f.b, f.c);
        const double v = cross(point, f.c, f.a);
        const double w = cross(point, f.a, f.b);
        const bool inside =
            whole > 0 ? u >= 0 && v >= 0 && w >= 0 : whole < 0 && u <= 0 && v <= 0 && w <= 0;
        if (!inside) {
            continue;
        }
        const double z = (u * f.a.z() + v * f.b.z() + w * f.c.z()) / whole;
        if (z > point.z() && (z < nearest || (z == nearest && whole > 0))) {
            nearest = z;
            solid = whole > 0 ? f.solid : -1;
        }
    }
    return solid;
}

}  // namespace decomp::partition
