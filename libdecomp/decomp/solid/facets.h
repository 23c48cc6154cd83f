// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/part/part.h"
#include "decomp/solid/adjacency.h"
#include "decomp/solid/regions.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace decomp::solid {

/// A flat region, or a triangle alone.
struct Facet {
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> points;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double area_mm2 = 0;
    bool cut = false;
};

/// Triangles alone that go all round a point.
struct Fan {
    std::uint32_t point = 0;
    std::vector<std::uint32_t> facets;
};

/// The facets of a mesh while they are gathered into curved regions. Facets below flat_count() are
/// the flat regions, the others are triangles alone.
class Facets {
  public:
    /// @param regions flat ones alone
    Facets(const part::Part& part, const Adjacency& adjacency, Regions& regions);

    [[nodiscard]] const Facet& operator[](std::uint32_t f) const { return facets_[f]; }

    [[nodiscard]] const Eigen::Vector3d& point(std::uint32_t p) const { return mesh_.points[p]; }

    [[nodiscard]] std::uint32_t flat_count() const { return flat_count_; }

    [[nodiscard]] bool is_flat(std::uint32_t f) const { return f < flat_count_; }

    [[nodiscard]] const PlaneSurface& plane(std::uint32_t flat) const;
    [[nodiscard]] double angle_between(std::uint32_t f, std::uint32_t g) const;

    /// Neither of a cut, nor part of a curved region, nor without area.
    [[nodiscard]] bool usable(std::uint32_t f) const {
        return !facets_[f].cut && !taken_[f] && facets_[f].area_mm2 > 0;
    }

    /// Pairs of usable neighbouring flat regions whose normals are turned by an angle between
    /// these, largest first.
    [[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(double least,
                                                                             double most) const;

    /// Of so many triangles at least, by their point.
    [[nodiscard]] std::vector<Fan> fans(std::size_t least) const;

    /// Calls visit for every halfedge of the triangles of a facet.
    template <class Visit>
    void for_each_halfedge(std::uint32_t f, const Visit& visit) const {
        for (const std::uint32_t t : facets_[f].triangles) {
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                visit(h);
            }
        }
    }

    /// The facet on the other side of a halfedge.
    [[nodiscard]] std::uint32_t across(std::uint32_t h) const {
        return facet_of_[adjacency_.twin[h] / 3];
    }

    /// From the start of a halfedge to its end.
    [[nodiscard]] Eigen::Vector3d way(std::uint32_t h) const {
        return mesh_.points[end_of(mesh_, h)] - mesh_.points[start_of(mesh_, h)];
    }

    /// The usable facets connected with `seed` that belong. is_outside() tells of the last call.
    [[nodiscard]] std::vector<std::uint32_t> gather(
        std::uint32_t seed, const std::function<bool(std::uint32_t)>& belongs);

    /// A flat region that is neither among the facets gathered last nor part of a curved one.
    [[nodiscard]] bool is_flat_outside(std::uint32_t g) const {
        return is_flat(g) && mark_[g] != stamp_ && !taken_[g];
    }

    /// Flat regions that touch these facets and are none of them, largest first.
    [[nodiscard]] std::vector<std::uint32_t> neighbours_of(
        const std::vector<std::uint32_t>& found) const;

    /// Curved regions that touch these facets, largest first.
    [[nodiscard]] std::vector<std::uint32_t> curved_neighbours_of(
        const std::vector<std::uint32_t>& found) const;

    /// Flat regions that touch these facets and are part of no curved one, largest first.
    [[nodiscard]] std::vector<std::uint32_t> flat_around(
        const std::vector<std::uint32_t>& found) const;

    /// Of each curved region, from flat_count() on.
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> curved_facets() const;

    [[nodiscard]] std::vector<std::uint32_t> points_of(
        const std::vector<std::uint32_t>& found) const;

    /// Each once, largest first.
    [[nodiscard]] std::vector<std::uint32_t> by_area(std::vector<std::uint32_t> facets) const;

    /// Makes one curved region of these facets.
    void keep(const std::vector<std::uint32_t>& found, const Surface& surface, bool outward,
              double sagitta_mm);

    /// Gives a curved region another surface.
    void lay(std::uint32_t r, const Surface& surface) { regions_.all[r].surface = surface; }

    [[nodiscard]] const Region& region(std::uint32_t r) const { return regions_.all[r]; }

  private:
    const mesh::TriMesh& mesh_;
    const Adjacency& adjacency_;
    Regions& regions_;
    std::uint32_t flat_count_ = 0;
    std::vector<Facet> facets_;
    std::vector<std::uint32_t> facet_of_;
    std::vector<bool> taken_;
    std::vector<std::uint32_t> mark_;
    std::uint32_t stamp_ = 0;
};

}  // namespace decomp::solid
