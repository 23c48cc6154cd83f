// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/flats.h"

#include "decomp/mesh/facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace decomp::mesh {

namespace {

constexpr int kGrid = 24;              // cells along an edge of a cube face
constexpr std::size_t kPeaks = 24;     // normals tried
constexpr double kFirstCone = 0.05;    // radians
constexpr double kMeantAsAxis = 1e-7;  // radians
constexpr double kSameArea = 1e-12;    // relative

std::size_t cube_cell(const Eigen::Vector3d& unit) {
    int axis = 0;
    unit.cwiseAbs().maxCoeff(&axis);
    const double scale = std::abs(unit[axis]);
    const auto cell = [&](double value) {
        return static_cast<std::size_t>(std::clamp(
            static_cast<int>(std::floor((value / scale + 1) / 2 * kGrid)), 0, kGrid - 1));
    };
    const std::size_t face = 2 * static_cast<std::size_t>(axis) + (unit[axis] < 0 ? 1 : 0);
    return (face * kGrid + cell(unit[(axis + 1) % 3])) * kGrid + cell(unit[(axis + 2) % 3]);
}

/// Mean normals of the fullest cells of the histogram, fullest first.
std::vector<Eigen::Vector3d> peak_normals(const Facets& facets, double min_share) {
    std::vector<Eigen::Vector3d> sums(std::size_t{6} * kGrid * kGrid, Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < facets.unit.size(); ++i) {
        if (facets.area_mm2[i] > 0) {
            sums[cube_cell(facets.unit[i])] += facets.area_mm2[i] * facets.unit[i];
        }
    }
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (sums[i].norm() > min_share / 2 * facets.total_mm2) {
            order.push_back(i);
        }
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return sums[a].norm() > sums[b].norm(); });
    order.resize(std::min(order.size(), kPeaks));
    std::vector<Eigen::Vector3d> normals;
    normals.reserve(order.size());
    for (const std::size_t cell : order) {
        normals.emplace_back(sums[cell].normalized());
    }
    return normals;
}

/// Narrows a cone about the normal, so that a curved surround does not tilt the plane of a flat.
Eigen::Vector3d narrowed(const Facets& facets, Eigen::Vector3d normal, double last_cone,
                         std::vector<std::uint32_t>& members) {
    members.clear();
    for (std::size_t i = 0; i < facets.unit.size(); ++i) {
        if (facets.unit[i].dot(normal) > 1 - kFirstCone * kFirstCone / 2) {
            members.push_back(static_cast<std::uint32_t>(i));
        }
    }
    for (double cone = kFirstCone; cone > last_cone / 2; cone /= 3) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const std::uint32_t i : members) {
            if ((facets.unit[i] - normal).squaredNorm() < cone * cone) {
                sum += facets.area_mm2[i] * facets.unit[i];
            }
        }
        if (sum.squaredNorm() == 0) {
            break;
        }
        normal = sum.normalized();
    }
    for (int axis = 0; axis < 3; ++axis) {
        Eigen::Vector3d unit = Eigen::Vector3d::Zero();
        unit[axis] = normal[axis] < 0 ? -1 : 1;
        if ((unit - normal).norm() < kMeantAsAxis) {
            normal = unit;  // what was meant as an axis is one
        }
    }
    std::erase_if(members,
                  [&](std::uint32_t i) { return (facets.unit[i] - normal).norm() > last_cone; });
    return normal;
}

/// The heaviest slab of thickness `planar` among the members' heights: outermost point and area.
Flat heaviest_level(const TriMesh& mesh, const Facets& facets, const Eigen::Vector3d& normal,
                    const std::vector<std::uint32_t>& members, double planar) {
    struct Level {
        double low, high, area;
    };

    std::vector<Level> levels;
    levels.reserve(members.size());
    for (const std::uint32_t i : members) {
        const Triangle& t = mesh.triangles[i];
        const std::array<double, 3> h{normal.dot(mesh.points[t[0]]), normal.dot(mesh.points[t[1]]),
                                      normal.dot(mesh.points[t[2]])};
        const auto [low, high] = std::minmax_element(h.begin(), h.end());
        if (*high - *low <= planar) {
            levels.push_back({*low, *high, facets.area_mm2[i]});
        }
    }
    std::stable_sort(levels.begin(), levels.end(),
                     [](const Level& a, const Level& b) { return a.high < b.high; });
    Flat best;
    best.normal = normal;
    std::size_t first = 0;
    double area = 0;
    for (std::size_t last = 0; last < levels.size(); ++last) {
        area += levels[last].area;
        while (levels[first].low < levels[last].high - planar && first < last) {
            area -= levels[first++].area;
        }
        // Equal areas: the outer level, on which the shape may stand.
        if (area >= best.area_mm2 * (1 - kSameArea)) {
            best.area_mm2 = area;
            best.offset_mm = levels[last].high;
        }
    }
    return best;
}

double outermost(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& normal) {
    double height = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& point : points) {
        height = std::max(height, normal.dot(point));
    }
    return height;
}

/// The points that triangles use, once each.
std::vector<Eigen::Vector3d> used_points(const TriMesh& mesh) {
    std::vector<bool> used(mesh.points.size(), false);
    std::vector<Eigen::Vector3d> out;
    out.reserve(mesh.points.size());
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t) {
            if (!used[v]) {
                used[v] = true;
                out.push_back(mesh.points[v]);
            }
        }
    }
    return out;
}

/// The area of the members within `planar` of the outermost height.
double area_at(const TriMesh& mesh, const Facets& facets, const std::vector<std::uint32_t>& members,
               const Eigen::Vector3d& normal, double least_height) {
    double area = 0;
    for (const std::uint32_t i : members) {
        const Triangle& t = mesh.triangles[i];
        if (std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
                return normal.dot(mesh.points[v]) >= least_height;
            })) {
            area += facets.area_mm2[i];
        }
    }
    return area;
}

}  // namespace

std::vector<Flat> large_flats(const TriMesh& mesh, const FlatOptions& options) {
    const Facets facets = measure_facets(mesh);
    const double least_area = options.min_share * facets.total_mm2;
    std::vector<Flat> flats;
    const auto add = [&](const Flat& flat) {
        const bool known = std::any_of(flats.begin(), flats.end(), [&](const Flat& other) {
            return (other.normal - flat.normal).norm() < options.normal_angle / 2 &&
                   std::abs(other.offset_mm - flat.offset_mm) <= options.planar_mm;
        });
        if (!known && flat.area_mm2 >= least_area && flat.area_mm2 > 0) {
            flats.push_back(flat);
        }
    };
    const std::vector<Eigen::Vector3d> points = used_points(mesh);
    std::vector<std::uint32_t> members;
    for (const Eigen::Vector3d& peak : peak_normals(facets, options.min_share)) {
        const Eigen::Vector3d normal = narrowed(facets, peak, options.normal_angle, members);
        const double top = outermost(points, normal);
        Flat outer;
        outer.normal = normal;
        outer.offset_mm = top;
        outer.on_hull = true;
        outer.area_mm2 = area_at(mesh, facets, members, normal, top - options.planar_mm);
        add(outer);
        add(heaviest_level(mesh, facets, normal, members, options.planar_mm));
    }
    std::stable_sort(flats.begin(), flats.end(),
                     [](const Flat& a, const Flat& b) { return a.area_mm2 > b.area_mm2; });
    return flats;
}

}  // namespace decomp::mesh
