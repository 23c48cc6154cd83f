// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/cutter/surface.h"

#include "decomp/mesh/facets.h"
#include "decomp/mesh/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cam::cutter {

namespace {

using decomp::mesh::Triangle;
using decomp::mesh::TriMesh;
using Eigen::Vector3d;

constexpr double kWall = 1e-7;         // upward part of a unit normal: below it no plane over XY
constexpr double kFacesDown = -1e-7;   // upward part of a unit normal: below it out of reach
constexpr double kVertical = 1e-12;    // mm in plan: such an edge has its top in another one
constexpr double kRounding = 1e-9;     // mm, of a plane's height
constexpr double kFacetsPerCell = 24;  // measured: fewer cost cells, more cost facets
constexpr double kSmallestCell = 0.25;
constexpr double kLargestCell = 4;

float lower_float(double value) {
    return std::nextafter(static_cast<float>(value), -std::numeric_limits<float>::infinity());
}

float upper_float(double value) {
    return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

/// Highest value of the facet's plane over a cell, never above its highest corner.
double top_over(const Surface::Facet& facet, double top, const Eigen::AlignedBox2d& cell) {
    if (!facet.has_plane) {
        return top;
    }
    const double x = facet.gx > 0 ? std::min<double>(cell.max().x(), facet.box[2])
                                  : std::max<double>(cell.min().x(), facet.box[0]);
    const double y = facet.gy > 0 ? std::min<double>(cell.max().y(), facet.box[3])
                                  : std::max<double>(cell.min().y(), facet.box[1]);
    const double plane =
        facet.z0 + facet.gx * (x - facet.corners[0]) + facet.gy * (y - facet.corners[1]);
    // The plane of a steep facet is rounded: leave room for it.
    return std::min(top, plane + kRounding * (1 + facet.steepness));
}

/// Whether a tool that rests on this edge would rest on one of its two facets as well.
bool is_valley(const TriMesh& mesh, const Triangle& beyond, const Vector3d& unit, std::size_t a,
               std::size_t b) {
    for (const std::uint32_t corner : beyond) {
        if (corner != a && corner != b) {
            return unit.dot(mesh.points[corner] - mesh.points[a]) >= 0;
        }
    }
    return false;
}

/// A facet without its edges.
Surface::Facet facet_of(const TriMesh& mesh, const Triangle& corner, const Vector3d& unit) {
    Surface::Facet facet;
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3d& p = mesh.points[corner[i]];
        facet.corners[2 * i] = p.x();
        facet.corners[2 * i + 1] = p.y();
        box.extend(p);
    }
    facet.box = {lower_float(box.min().x()), lower_float(box.min().y()), upper_float(box.max().x()),
                 upper_float(box.max().y())};
    facet.has_plane = unit.z() > kWall;
    if (facet.has_plane) {
        facet.gx = -unit.x() / unit.z();
        facet.gy = -unit.y() / unit.z();
        facet.steepness = std::hypot(facet.gx, facet.gy);
        facet.stretch = std::hypot(1, facet.steepness);
        facet.z0 = mesh.points[corner[0]].z();
    }
    return facet;
}

}  // namespace

Surface::Surface(const TriMesh& mesh) : bounds_(decomp::mesh::bounds(mesh)) {
    if (mesh.triangles.empty()) {
        return;
    }
    collect_facets(mesh);
    sort_into_cells();
}

void Surface::collect_facets(const TriMesh& mesh) {
    const decomp::mesh::Facets measured = decomp::mesh::measure_facets(mesh);
    const auto beside = decomp::mesh::neighbours(mesh);
    const auto up = [&](std::size_t t) { return measured.unit[t].z() > kFacesDown; };
    // Whether facet t leaves an edge out: a facet before it has it, or no tool rests on it.
    const auto is_spare = [&](std::size_t t, std::size_t edge) {
        const std::int32_t other = beside[t][edge];
        if (other < 0 || !up(static_cast<std::size_t>(other))) {
            return false;
        }
        const auto o = static_cast<std::size_t>(other);
        const Triangle& corner = mesh.triangles[t];
        const bool both = measured.unit[t].z() > kWall && measured.unit[o].z() > kWall;
        return o < t || (both && is_valley(mesh, mesh.triangles[o], measured.unit[t], corner[edge],
                                           corner[(edge + 1) % 3]));
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!up(t)) {
            continue;
        }
        const Triangle& corner = mesh.triangles[t];
        Facet facet = facet_of(mesh, corner, measured.unit[t]);
        facet.first_edge = static_cast<std::uint32_t>(edges_.size());
        for (std::size_t i = 0; i < 3; ++i) {
            if (!is_spare(t, i)) {
                add_edge(mesh.points[corner[i]], mesh.points[corner[(i + 1) % 3]]);
            }
        }
        facet.edges = static_cast<std::uint32_t>(edges_.size()) - facet.first_edge;
        facets_.push_back(facet);
        facet_tops_.push_back(std::max(
            {mesh.points[corner[0]].z(), mesh.points[corner[1]].z(), mesh.points[corner[2]].z()}));
    }
}

void Surface::add_edge(const Vector3d& from, const Vector3d& to) {
    const Vector3d along = to - from;
    const double length = std::hypot(along.x(), along.y());
    if (length > kVertical) {
        edges_.push_back({from.x(), from.y(), from.z(), along.x() / length, along.y() / length,
                          length, along.z() / length, along.z() / along.norm()});
    }
}

void Surface::sort_into_cells() {
    const Eigen::Vector2d low = bounds_.min().head<2>();
    const Eigen::Vector2d size = bounds_.sizes().head<2>();
    const double per_facet =
        size.x() * size.y() / static_cast<double>(std::max<std::size_t>(1, facets_.size()));
    cell_ = std::clamp(std::sqrt(per_facet * kFacetsPerCell), kSmallestCell, kLargestCell);
    columns_ = 1 + static_cast<int>(size.x() / cell_);
    rows_ = 1 + static_cast<int>(size.y() / cell_);
    const auto column_of = [&](double x) {
        return std::clamp(static_cast<int>((x - low.x()) / cell_), 0, columns_ - 1);
    };
    const auto row_of = [&](double y) {
        return std::clamp(static_cast<int>((y - low.y()) / cell_), 0, rows_ - 1);
    };
    const auto for_cells = [&](const Facet& facet, const auto& visit) {
        for (int row = row_of(facet.box[1]); row <= row_of(facet.box[3]); ++row) {
            for (int column = column_of(facet.box[0]); column <= column_of(facet.box[2]);
                 ++column) {
                visit(column, row,
                      static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                          static_cast<std::size_t>(column));
            }
        }
    };
    starts_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const Facet& facet : facets_) {
        for_cells(facet, [&](int, int, std::size_t cell) { ++starts_[cell + 1]; });
    }
    for (std::size_t cell = 1; cell < starts_.size(); ++cell) {
        starts_[cell] += starts_[cell - 1];
    }
    entries_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
        for_cells(facets_[f], [&](int column, int row, std::size_t cell) {
            const Eigen::Vector2d corner = low + cell_ * Eigen::Vector2d(column, row);
            const Eigen::AlignedBox2d box(corner, corner + Eigen::Vector2d(cell_, cell_));
            entries_[next[cell]++] = {top_over(facets_[f], facet_tops_[f], box), f};
        });
    }
    for (std::size_t cell = 0; cell + 1 < starts_.size(); ++cell) {
        std::sort(entries_.begin() + static_cast<std::ptrdiff_t>(starts_[cell]),
                  entries_.begin() + static_cast<std::ptrdiff_t>(starts_[cell + 1]),
                  [](const Entry& a, const Entry& b) {
                      return a.top != b.top ? a.top > b.top : a.facet < b.facet;
                  });
    }
}

}  // namespace cam::cutter
