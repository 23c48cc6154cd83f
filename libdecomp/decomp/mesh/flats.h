// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <vector>

namespace decomp::mesh {

/// A flat region of a surface: triangles (not necessarily connected) in one plane, outward normal.
struct Flat {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length
    double offset_mm = 0;  ///< normal . x of the region's outermost point
    double area_mm2 = 0;
    bool on_hull =
        false;  ///< no point of the mesh lies beyond the plane: the shape can stand on it
};

struct FlatOptions {
    double min_share = 0.005;    ///< of the mesh's area
    double planar_mm = 0.01;     ///< the region's points deviate from its plane by no more
    double normal_angle = 2e-3;  ///< radians by which a triangle of the region may tilt
};

/// The flat regions that touch the convex hull, and the largest others, by falling area (ties by
/// discovery order). Finds normals by a histogram over a cube map, then refines them. O(n) per
/// region, at most 24 normals are tried.
[[nodiscard]] std::vector<Flat> large_flats(const TriMesh& mesh, const FlatOptions& options = {});

}  // namespace decomp::mesh
