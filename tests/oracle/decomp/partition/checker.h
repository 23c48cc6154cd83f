// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/part.h"

#include <set>
#include <string>

/// A second opinion on partitions. Shares nothing with the cutter: values in, faults out.
namespace tests {

enum class Fault {
    Open,         ///< an edge with other than two triangles
    Misoriented,  ///< an edge that its two triangles run alike, or a volume that is not positive
    Components,   ///< more than one body in a part
    Crossing,     ///< triangles of a part intersect
    Twin,         ///< a cut triangle without its mirror image in the part that it names
    Gap,          ///< a point of the shape in no part
    Overlap,      ///< a point in two parts, or in a part and outside of the shape
    NotPlanar,    ///< a cut triangle off its plane
    Volume,       ///< volumes do not sum up
};

struct CheckOptions {
    int points = 400;         ///< sampled for gaps and overlaps
    double planar_mm = 1e-9;  ///< times the diagonal of the shape
    double volume = 1e-9;     ///< of the shape's volume
};

/// Everything that is wrong with a partition of a shape; empty for a sound one.
[[nodiscard]] std::set<Fault> faults_of(const decomp::part::Assembly& assembly,
                                        const decomp::mesh::TriMesh& shape,
                                        const CheckOptions& options = {});

/// Whether triangles of a closed mesh intersect elsewhere than in common edges and points (CGAL).
[[nodiscard]] bool crosses_itself(const decomp::mesh::TriMesh& mesh);

}  // namespace tests
