// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/plane.h"

#include <cstdint>
#include <string>
#include <vector>

namespace decomp::part {

/// Where a facet of a part comes from: the input surface, or a cut.
struct FacetSource {
    std::int32_t plane = -1;  ///< index in Assembly::planes; -1 on the input surface
    std::int32_t neighbour =
        -1;  ///< index in Assembly::parts of the part on the other side; -1 on the input surface

    [[nodiscard]] bool is_cut() const { return plane >= 0; }
};

/// One part in the model frame. Closed, manifold, outward oriented; a cut facet occurs in exactly
/// two parts, with the same three points bit for bit and opposite orientation.
struct Part {
    std::string id;                    ///< "P01", dense and sorted
    mesh::TriMesh mesh;                ///< mm, model frame
    std::vector<FacetSource> sources;  ///< one for each triangle
};

/// Two parts that touch along facets of one plane.
struct Interface {
    std::int32_t plane = -1;
    std::int32_t part_a = -1;
    std::int32_t part_b = -1;
    double area_mm2 = 0;
};

/// All parts of one shape; drawn together they are the shape.
struct Assembly {
    std::vector<Plane> planes;
    std::vector<Part> parts;
    std::vector<Interface> interfaces;  ///< sorted by (part_a, part_b, plane), part_a < part_b
};

}  // namespace decomp::part
