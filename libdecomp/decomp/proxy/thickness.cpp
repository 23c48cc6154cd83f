// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/proxy/thickness.h"

#include "decomp/mesh/measure.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace decomp::proxy {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

constexpr double kStartShare = 1e-5;  // of the diagonal: rays start so far below the surface

Kernel::Point_3 point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

constexpr double kFacesBack = -0.7;  // cosine between two facets that see each other

struct Hit {
    double distance;
    Eigen::Vector3d normal;
};

/// Where a ray from near the surface meets it first; nothing: nowhere.
std::optional<Hit> first_hit(const Tree& tree, const Eigen::Vector3d& start,
                             const Eigen::Vector3d& direction) {
    const auto hit = tree.first_intersection(
        Kernel::Ray_3(point(start), Kernel::Vector_3(direction.x(), direction.y(), direction.z())));
    if (!hit) {
        return std::nullopt;
    }
    const auto* at = boost::get<Kernel::Point_3>(&hit->first);
    if (at == nullptr) {  // the ray runs within a triangle
        return std::nullopt;
    }
    const Kernel::Vector_3 n = CGAL::cross_product(hit->second->vertex(1) - hit->second->vertex(0),
                                                   hit->second->vertex(2) - hit->second->vertex(0));
    return Hit{(Eigen::Vector3d(at->x(), at->y(), at->z()) - start).norm(),
               Eigen::Vector3d(n.x(), n.y(), n.z()).normalized()};
}

Triangles triangles_of(const mesh::TriMesh& surface) {
    Triangles triangles;
    triangles.reserve(surface.triangles.size());
    for (const auto& t : surface.triangles) {
        triangles.emplace_back(point(surface.points[t[0]]), point(surface.points[t[1]]),
                               point(surface.points[t[2]]));
    }
    return triangles;
}

Eigen::Vector3d centre_of(const mesh::TriMesh& surface, std::size_t i) {
    const auto& t = surface.triangles[i];
    return (surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) / 3;
}

}  // namespace

double thickness_mm(const mesh::TriMesh& surface, double share, std::size_t samples) {
    const Triangles triangles = triangles_of(surface);
    const Tree tree(triangles.cbegin(), triangles.cend());
    const double step = mesh::area_mm2(surface) / static_cast<double>(samples);
    const double below_mm = kStartShare * mesh::diagonal_mm(surface);
    std::vector<double> depths;
    double passed = step / 2;  // area walked since the last sample
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        const Eigen::Vector3d normal = mesh::double_area_normal(surface, i);
        const double area = normal.norm() / 2;
        passed += area;
        if (passed < step || area <= 0) {
            continue;
        }
        passed = std::fmod(passed, step);
        const Eigen::Vector3d inward = -normal.normalized();
        if (const auto found = first_hit(tree, centre_of(surface, i) + below_mm * inward, inward)) {
            depths.push_back(found->distance);
        }
    }
    if (depths.empty()) {
        return 0;
    }
    const auto rank = static_cast<std::size_t>(share * static_cast<double>(depths.size() - 1));
    std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(rank),
                     depths.end());
    return depths[rank];
}

std::vector<double> tunnel_widths_mm(const mesh::TriMesh& surface, std::size_t stride) {
    const Triangles triangles = triangles_of(surface);
    const Tree tree(triangles.cbegin(), triangles.cend());
    const double above_mm = kStartShare * mesh::diagonal_mm(surface);
    std::vector<double> widths(surface.triangles.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < surface.triangles.size(); i += stride) {
        const Eigen::Vector3d normal = mesh::double_area_normal(surface, i).normalized();
        const auto hit = first_hit(tree, centre_of(surface, i) + above_mm * normal, normal);
        if (hit && hit->normal.dot(normal) < kFacesBack) {
            widths[i] = hit->distance;
        }
    }
    return widths;
}

}  // namespace decomp::proxy
