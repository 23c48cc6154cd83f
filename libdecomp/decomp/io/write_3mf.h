// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace decomp::io {

/// One object of a 3MF file: named, and placed by a rigid motion.
struct ThreemfObject {
    std::string id;
    mesh::TriMesh mesh;  ///< mm, closed and outward
    Eigen::Isometry3d placed_from_mesh =
        Eigen::Isometry3d::Identity();  ///< e.g. Pose::map() from model to bed
};

/// A 3MF package in millimetres, one object and one build item for each. Coordinates are float32,
/// as lib3mf keeps them. Equal objects give equal bytes: the time stamps of the zip entries are set
/// to 1980-01-01.
/// @error io.threemf  lib3mf refuses an object (a triangle that repeats a corner, a coordinate
/// beyond its range)
[[nodiscard]] Result<std::string> threemf_bytes(const std::vector<ThreemfObject>& objects);

}  // namespace decomp::io
