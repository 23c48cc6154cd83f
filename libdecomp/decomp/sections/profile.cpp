// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sections/profile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace decomp::sections {

namespace {

/// The segment in which a triangle meets a height, with material on its left seen from above, and
/// its motion with the height. `entry` and `exit` name the cut edges (from, to local corners).
struct Crossing {
    Eigen::Vector2d from, to;
    Eigen::Vector2d from_velocity, to_velocity;
    std::array<std::uint32_t, 2> from_edge, to_edge;  // vertex pairs, smaller first
};

struct Cut {
    Eigen::Vector2d point, velocity;
    std::array<std::uint32_t, 2> edge;
};

Cut cut_edge(const std::vector<Eigen::Vector3d>& points, std::uint32_t a, std::uint32_t b,
             double t) {
    // The same order of operands from both triangles, so that neighbours compute the same point.
    if (a > b) {
        std::swap(a, b);
    }
    const Eigen::Vector3d& p = points[a];
    const Eigen::Vector3d& q = points[b];
    const Eigen::Vector2d velocity = (q.head<2>() - p.head<2>()) / (q.z() - p.z());
    return {p.head<2>() + (t - p.z()) * velocity, velocity, {a, b}};
}

/// A corner at the height itself counts as above (symbolic perturbation), so every section is made
/// of closed curves.
bool crossing_of(const std::vector<Eigen::Vector3d>& points, const mesh::Triangle& triangle,
                 double t, Crossing& out) {
    std::array<bool, 3> above{};
    int count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        above.at(i) = points[triangle.at(i)].z() >= t;
        count += above.at(i) ? 1 : 0;
    }
    if (count == 0 || count == 3) {
        return false;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = triangle.at(i);
        const std::uint32_t b = triangle.at((i + 1) % 3);
        if (above.at(i) == above.at((i + 1) % 3)) {
            continue;
        }
        const Cut cut = cut_edge(points, a, b, t);
        // Outward normals and counter-clockwise triangles: the section runs, material on its left,
        // from the edge that goes down to the edge that goes up.
        if (above.at(i)) {
            out.from = cut.point;
            out.from_velocity = cut.velocity;
            out.from_edge = cut.edge;
        } else {
            out.to = cut.point;
            out.to_velocity = cut.velocity;
            out.to_edge = cut.edge;
        }
    }
    return true;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Closed curves of one section: joined by shared edges, told apart by the sign of their area.
class Curves {
  public:
    void add(const Crossing& crossing) {
        edges_.push_back({crossing.from_edge, static_cast<std::uint32_t>(areas_.size())});
        edges_.push_back({crossing.to_edge, static_cast<std::uint32_t>(areas_.size())});
        areas_.push_back(cross(crossing.from, crossing.to) / 2);
    }

    void count(Station& station) {
        std::vector<std::uint32_t> parent(areas_.size());
        std::iota(parent.begin(), parent.end(), 0U);
        const auto root = [&](std::uint32_t i) {
            while (parent[i] != i) {
                parent[i] = parent[parent[i]];
                i = parent[i];
            }
            return i;
        };
        std::sort(edges_.begin(), edges_.end(), [](const End& a, const End& b) {
            return a.edge != b.edge ? a.edge < b.edge : a.segment < b.segment;
        });
        for (std::size_t i = 1; i < edges_.size(); ++i) {
            if (edges_[i].edge == edges_[i - 1].edge) {
                const std::uint32_t a = root(edges_[i - 1].segment);
                const std::uint32_t b = root(edges_[i].segment);
                parent[std::max(a, b)] = std::min(a, b);
            }
        }
        std::vector<double> sums(areas_.size(), 0.0);
        for (std::uint32_t i = 0; i < areas_.size(); ++i) {
            sums[root(i)] += areas_[i];
        }
        for (std::uint32_t i = 0; i < areas_.size(); ++i) {
            if (parent[i] == i) {
                (sums[i] >= 0 ? station.outlines : station.holes) += 1;
            }
        }
    }

  private:
    struct End {
        std::array<std::uint32_t, 2> edge;
        std::uint32_t segment;
    };

    std::vector<End> edges_;
    std::vector<double> areas_;
};

}  // namespace

std::array<Eigen::Vector3d, 2> plane_basis(const Eigen::Vector3d& direction) {
    int least = 0;
    direction.cwiseAbs().minCoeff(&least);
    const Eigen::Vector3d u = Eigen::Vector3d::Unit(least).cross(direction).normalized();
    return {u, direction.cross(u)};
}

Profile::Profile(const mesh::TriMesh& mesh, const Eigen::Vector3d& direction, int stations)
    : mesh_(&mesh), direction_(direction) {
    const auto [u, v] = plane_basis(direction);
    // Centring keeps the areas of curves far from the origin free of cancellation.
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& point : mesh.points) {
        centre += point;
    }
    centre /= std::max<double>(1, static_cast<double>(mesh.points.size()));
    points_.reserve(mesh.points.size());
    for (const Eigen::Vector3d& point : mesh.points) {
        points_.emplace_back(u.dot(point - centre), v.dot(point - centre), direction.dot(point));
    }
    low_ = std::numeric_limits<double>::infinity();
    high_ = -low_;
    for (const mesh::Triangle& t : mesh.triangles) {
        for (const std::uint32_t corner : t) {
            low_ = std::min(low_, points_[corner].z());
            high_ = std::max(high_, points_[corner].z());
        }
    }
    if (mesh.triangles.empty() || stations < 1 || high_ <= low_) {
        return;
    }
    stations_.resize(static_cast<std::size_t>(stations));
    sort_into_slabs();
    const double step = (high_ - low_) / stations;
    for (std::size_t i = 0; i < stations_.size(); ++i) {
        stations_[i] = measure(low_ + (static_cast<double>(i) + 0.5) * step, true);
    }
}

std::size_t Profile::slab_of(double t_mm) const {
    const auto count = static_cast<double>(stations_.size());
    const double slab = std::floor((t_mm - low_) / (high_ - low_) * count);
    return static_cast<std::size_t>(std::clamp(slab, 0.0, count - 1));
}

void Profile::sort_into_slabs() {
    const auto span = [&](const mesh::Triangle& t) {
        const auto [low, high] =
            std::minmax({points_[t[0]].z(), points_[t[1]].z(), points_[t[2]].z()});
        return std::array<std::size_t, 2>{slab_of(low), slab_of(high)};
    };
    slab_begin_.assign(stations_.size() + 1, 0);
    for (const mesh::Triangle& t : mesh_->triangles) {
        const auto [first, last] = span(t);
        for (std::size_t slab = first; slab <= last; ++slab) {
            ++slab_begin_[slab + 1];
        }
    }
    std::partial_sum(slab_begin_.begin(), slab_begin_.end(), slab_begin_.begin());
    slab_triangles_.resize(slab_begin_.back());
    std::vector<std::uint32_t> next(slab_begin_.begin(), slab_begin_.end() - 1);
    for (std::uint32_t i = 0; i < mesh_->triangles.size(); ++i) {
        const auto [first, last] = span(mesh_->triangles[i]);
        for (std::size_t slab = first; slab <= last; ++slab) {
            slab_triangles_[next[slab]++] = i;
        }
    }
}

Station Profile::measure(double t_mm, bool with_topology) const {
    Station station;
    station.t_mm = t_mm;
    const std::size_t slab = slab_of(t_mm);
    Curves curves;
    Crossing crossing;
    for (std::uint32_t k = slab_begin_[slab]; k < slab_begin_[slab + 1]; ++k) {
        if (!crossing_of(points_, mesh_->triangles[slab_triangles_[k]], t_mm, crossing)) {
            continue;
        }
        station.area_mm2 += cross(crossing.from, crossing.to) / 2;
        station.slope_mm += (cross(crossing.from_velocity, crossing.to) +
                             cross(crossing.from, crossing.to_velocity)) /
                            2;
        if (with_topology) {
            curves.add(crossing);
        }
    }
    if (with_topology) {
        curves.count(station);
    }
    return station;
}

Station Profile::at(double t_mm) const {
    if (stations_.empty() || t_mm <= low_ || t_mm >= high_) {
        Station outside;
        outside.t_mm = t_mm;
        return outside;
    }
    return measure(t_mm, true);
}

double section_area(const mesh::TriMesh& mesh, const part::Plane& plane) {
    const double length = plane.normal.norm();
    const Eigen::Vector3d direction = plane.normal / length;
    const auto basis = plane_basis(direction);
    const double t = plane.offset_mm / length;
    std::vector<double> heights(mesh.points.size());
    for (std::size_t i = 0; i < heights.size(); ++i) {
        heights[i] = direction.dot(mesh.points[i]) - t;
    }
    const Eigen::Vector3d origin =
        mesh.points.empty() ? Eigen::Vector3d::Zero() : mesh.points.front();
    const auto point_on = [&](std::uint32_t a, std::uint32_t b) {
        if (a > b) {
            std::swap(a, b);
        }
        const double s = heights[a] / (heights[a] - heights[b]);
        const Eigen::Vector3d p = mesh.points[a] + s * (mesh.points[b] - mesh.points[a]) - origin;
        return Eigen::Vector2d(basis[0].dot(p), basis[1].dot(p));
    };
    double area = 0;
    for (const mesh::Triangle& triangle : mesh.triangles) {
        std::array<bool, 3> above{};
        for (std::size_t i = 0; i < 3; ++i) {
            above.at(i) = heights[triangle.at(i)] >= 0;
        }
        if (above[0] == above[1] && above[1] == above[2]) {
            continue;
        }
        Eigen::Vector2d from = Eigen::Vector2d::Zero();
        Eigen::Vector2d to = Eigen::Vector2d::Zero();
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            if (above.at(i) != above.at(j)) {
                (above.at(i) ? from : to) = point_on(triangle.at(i), triangle.at(j));
            }
        }
        area += cross(from, to) / 2;
    }
    return area;
}

}  // namespace decomp::sections
