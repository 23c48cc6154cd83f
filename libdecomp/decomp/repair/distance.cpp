// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace decomp::repair {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

double farthest_mm(const mesh::TriMesh& from, const mesh::TriMesh& to) {
    Triangles triangles;
    for (const auto& t : to.triangles) {
        const Kernel::Triangle_3 triangle(point(to.points[t[0]]), point(to.points[t[1]]),
                                          point(to.points[t[2]]));
        if (!triangle.is_degenerate()) {  // a sliver has no plane to measure from; its neighbours
                                          // cover it
            triangles.push_back(triangle);
        }
    }
    if (triangles.empty() || from.triangles.empty()) {
        return 0;
    }
    const Tree tree(triangles.cbegin(), triangles.cend());
    double farthest = 0;
    std::vector<bool> used(from.points.size(), false);
    for (const auto& t : from.triangles) {
        const Eigen::Vector3d centre =
            (from.points[t[0]] + from.points[t[1]] + from.points[t[2]]) / 3;
        farthest = std::max(farthest, tree.squared_distance(point(centre)));
        for (const auto corner : t) {
            if (!used[corner]) {
                used[corner] = true;
                farthest = std::max(farthest, tree.squared_distance(point(from.points[corner])));
            }
        }
    }
    return std::sqrt(farthest);
}

}  // namespace decomp::repair
