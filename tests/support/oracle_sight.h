// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Dense>

#include <cmath>
#include <cstddef>

/// Who sees whom, by brute force in double precision: every triangle against every ray.
namespace tests {

using decomp::mesh::TriMesh;

/// Whether the ray origin + t * direction, t > 0, meets the triangle. Signed volumes: the ray's
/// line passes the three edges on the same side.
inline bool ray_meets(const TriMesh& mesh, std::size_t triangle, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& direction) {
    const auto& t = mesh.triangles[triangle];
    const Eigen::Vector3d a = mesh.points[t[0]] - origin;
    const Eigen::Vector3d b = mesh.points[t[1]] - origin;
    const Eigen::Vector3d c = mesh.points[t[2]] - origin;
    const double ab = direction.dot(a.cross(b));
    const double bc = direction.dot(b.cross(c));
    const double ca = direction.dot(c.cross(a));
    const bool through = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    const double sum = ab + bc + ca;
    if (!through || sum == 0) {
        return false;
    }
    return a.dot((b - a).cross(c - a)) / direction.dot((b - a).cross(c - a)) > 0;
}

/// A facet sees a direction when it faces it and no other triangle is in the way of its barycentre,
/// lifted by `lift_mm` along the normal.
inline bool oracle_sees(const TriMesh& mesh, std::size_t facet, const Eigen::Vector3d& direction,
                        double lift_mm) {
    const auto& t = mesh.triangles[facet];
    const Eigen::Vector3d normal =
        (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]);
    if (!(normal.dot(direction) > 0)) {
        return false;
    }
    const Eigen::Vector3d origin = (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3 +
                                   lift_mm * normal.normalized();
    for (std::size_t other = 0; other < mesh.triangles.size(); ++other) {
        if (other != facet && ray_meets(mesh, other, origin, direction)) {
            return false;
        }
    }
    return true;
}

}  // namespace tests
