// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/measure.h"
#include "decomp/solid/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace decomp::solid {

namespace {

class PlaneFinder {
  public:
    PlaneFinder(const part::Part& part, const Adjacency& adjacency, const RegionOptions& options)
        : mesh_(part.mesh), part_(part), adjacency_(adjacency), options_(options) {
        regions_.of.assign(mesh_.triangles.size(), -1);
    }

    Regions find() {
        std::vector<std::uint32_t> order(mesh_.triangles.size());
        std::iota(order.begin(), order.end(), 0U);
        std::vector<double> area(order.size());
        for (std::uint32_t t : order) {
            area[t] = mesh::double_area_normal(mesh_, t).norm() / 2;
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return area[a] > area[b]; });
        for (const std::uint32_t seed : order) {
            if (regions_.of[seed] == -1 && area[seed] > 0 && (options_.flat || is_cut(seed))) {
                grow(seed);
            }
        }
        regions_.plane_of = regions_.band_of = regions_.of;
        return std::move(regions_);
    }

  private:
    [[nodiscard]] PlaneSurface plane_of(const std::vector<std::uint32_t>& triangles) const {
        Eigen::Vector3d normal = Eigen::Vector3d::Zero();
        for (const std::uint32_t t : triangles) {
            normal += mesh::double_area_normal(mesh_, t);
        }
        PlaneSurface plane;
        plane.normal = snapped(normal.normalized());
        double lowest = std::numeric_limits<double>::infinity();
        double highest = -lowest;
        for (const std::uint32_t t : triangles) {
            for (const std::uint32_t corner : mesh_.triangles[t]) {
                const double height = plane.normal.dot(mesh_.points[corner]);
                lowest = std::min(lowest, height);
                highest = std::max(highest, height);
            }
        }
        plane.offset_mm = (lowest + highest) / 2;
        return plane;
    }

    /// Planes square to an axis are so exactly: rounding of the last bits would spoil their
    /// dimensions.
    static Eigen::Vector3d snapped(const Eigen::Vector3d& normal) {
        constexpr double kSquare = 1e-15;
        Eigen::Index axis = 0;
        const double largest = normal.cwiseAbs().maxCoeff(&axis);
        if (1 - largest < kSquare) {
            return Eigen::Vector3d::Unit(axis) * (normal[axis] > 0 ? 1 : -1);
        }
        return normal;
    }

    [[nodiscard]] bool is_cut(std::uint32_t t) const {
        return !part_.sources.empty() && part_.sources[t].is_cut();
    }

    [[nodiscard]] bool same_cut(std::uint32_t a, std::uint32_t b) const {
        return part_.sources.empty() || part_.sources[a].plane == part_.sources[b].plane;
    }

    [[nodiscard]] bool lies_in(const PlaneSurface& plane, std::uint32_t t) const {
        for (const std::uint32_t corner : mesh_.triangles[t]) {
            if (std::abs(distance_mm(plane, mesh_.points[corner])) > options_.planar_mm) {
                return false;
            }
        }
        const Eigen::Vector3d normal = mesh::double_area_normal(mesh_, t);
        // The normal of a needle says nothing.
        const double longest = longest_side(t);
        return normal.norm() <= 4 * options_.planar_mm * longest ||
               normal.dot(plane.normal) > 0.5 * normal.norm();
    }

    [[nodiscard]] double longest_side(std::uint32_t t) const {
        const mesh::Triangle& c = mesh_.triangles[t];
        return std::max({(mesh_.points[c[0]] - mesh_.points[c[1]]).norm(),
                         (mesh_.points[c[1]] - mesh_.points[c[2]]).norm(),
                         (mesh_.points[c[2]] - mesh_.points[c[0]]).norm()});
    }

    [[nodiscard]] std::vector<std::uint32_t> spread(std::uint32_t seed, const PlaneSurface& plane) {
        std::vector<std::uint32_t> found{seed};
        mark_.resize(mesh_.triangles.size(), 0);
        ++stamp_;
        mark_[seed] = stamp_;
        for (std::size_t i = 0; i < found.size(); ++i) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t other = adjacency_.twin[3 * found[i] + k] / 3;
                if (mark_[other] != stamp_ && regions_.of[other] == -1 && same_cut(seed, other) &&
                    lies_in(plane, other)) {
                    mark_[other] = stamp_;
                    found.push_back(other);
                }
            }
        }
        return found;
    }

    void grow(std::uint32_t seed) {
        PlaneSurface plane = plane_of({seed});
        std::vector<std::uint32_t> found = spread(seed, plane);
        if (found.size() < 2) {
            return;
        }
        // The seed's own normal is the worst guess; the region's is better.
        for (int round = 0; round < 2; ++round) {
            const PlaneSurface better = plane_of(found);
            std::vector<std::uint32_t> again = spread(seed, better);
            if (again.size() < found.size()) {
                break;
            }
            plane = better;
            found = std::move(again);
        }
        if (found.size() < 2) {
            return;
        }
        plane = plane_of(found);
        Region region{plane, true, 0, 0};
        for (const std::uint32_t t : found) {
            regions_.of[t] = static_cast<std::int32_t>(regions_.all.size());
            region.area_mm2 += mesh::double_area_normal(mesh_, t).norm() / 2;
        }
        regions_.all.push_back(region);
    }

    const mesh::TriMesh& mesh_;
    const part::Part& part_;
    const Adjacency& adjacency_;
    const RegionOptions& options_;
    Regions regions_;
    std::vector<std::uint32_t> mark_;
    std::uint32_t stamp_ = 0;
};

}  // namespace

Regions find_planes(const part::Part& part, const Adjacency& adjacency,
                    const RegionOptions& options) {
    return PlaneFinder(part, adjacency, options).find();
}

}  // namespace decomp::solid
