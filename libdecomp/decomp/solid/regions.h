// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/part/part.h"
#include "decomp/solid/adjacency.h"
#include "decomp/solid/solid.h"

#include <cstdint>
#include <vector>

namespace decomp::solid {

/// Triangles that lie on one surface.
struct Region {
    Surface surface;
    bool outward = true;
    double area_mm2 = 0;
    double sagitta_mm = 0;  ///< how far the triangles stay behind a curved surface
};

/// Which triangle belongs to which region.
struct Regions {
    std::vector<std::int32_t> of;        ///< for each triangle; -1: a face of its own
    std::vector<std::int32_t> plane_of;  ///< the same before curved regions were found
    std::vector<std::int32_t> band_of;   ///< the same before cones and cylinders were made tori
    std::vector<Region> all;
};

struct RegionOptions {
    double planar_mm = 1e-5;     ///< points of a plane deviate by no more
    double tolerance_mm = 0.02;  ///< points of a curved surface deviate by no more
    bool flat = true;            ///< look for flat regions of the input surface
};

/// Flat regions: connected triangles of one cut, and connected triangles of the input surface whose
/// points lie in one plane. Grown from the largest triangle down. O(n log n).
[[nodiscard]] Regions find_planes(const part::Part& part, const Adjacency& adjacency,
                                  const RegionOptions& options);

/// Joins flat strips and triangles which chord one cylinder, then those which chord one cone. A
/// strip is a flat region with two straight sides that are parallel or meet in the apex; a surface
/// has three at least, none turned about the axis against its neighbour by more than 31 degrees,
/// and points that deviate from it far less than the strips do. The axis is laid square to a flat
/// neighbour, along it, or on the axis of a curved one, where it almost is. Then such bands about
/// one axis, three at least, whose rims lie on one circle of the half plane through it become a
/// torus.
void find_curved(const part::Part& part, const Adjacency& adjacency, const RegionOptions& options,
                 Regions& regions);

}  // namespace decomp::solid
