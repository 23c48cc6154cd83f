// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/units.h"
#include "decomp/mesh/facets.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cam::orient {

inline constexpr double kOnPlateMm = 0.02;  ///< facets this low lie on the plate

/// How a facet lies in one pose.
enum class Lie : std::uint8_t {
    Free,      ///< carries itself
    Overhang,  ///< faces down flatter than the support angle, above the plate
    Plate      ///< lies on the plate
};

/// A surface in one pose: what hangs over, by area and by number of facets.
struct Overhang {
    std::vector<Lie> lie;  ///< of each facet
    double overhang_mm2 = 0;
    std::size_t overhang_facets = 0;
    double plate_mm2 = 0;
    std::size_t plate_facets = 0;
    double base_mm2 = 0;  ///< of what lies on the plate, the level part: it carries the shape
};

/// A facet hangs over when its normal is less than the support angle away from `down`: 45 degrees
/// is a plane at 45 degrees to the horizontal, 0 is never. The plate touches the mesh's outermost
/// point along `down`.
/// @param down         unit length
/// @param on_plate_mm  what lies no higher above the plate lies on it
[[nodiscard]] Overhang find_overhang(const decomp::mesh::TriMesh& mesh,
                                     const decomp::mesh::Facets& facets,
                                     const Eigen::Vector3d& down, decomp::Angle support_angle,
                                     double on_plate_mm = kOnPlateMm);

}  // namespace cam::orient
