// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/orient/overhang.h"
#include "decomp/mesh/facets.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace cam::check {

/// What a facet is to a printer, in one pose.
enum class Hanging : std::uint8_t {
    Free,      ///< carries itself
    Plate,     ///< lies on the plate
    Overhang,  ///< leans out too far
    Bridge,    ///< level, and short enough between things to rest on: needs no support
    Island     ///< part of what begins in the air
};

struct HangingOptions {
    double longest_bridge_mm = 12;
    double layer_height_mm = 0.2;  ///< lower bumps begin no island
};

/// Tells bridges and islands apart from overhang.
///
/// Island: a point with nothing lower around it, above the plate, whose surroundings join
/// something that stands only more than a layer higher up; the overhang below that joint belongs
/// to it.
/// Bridge: a connected, nearly level (10 degrees) patch of overhang for which a direction exists
/// (of 36) in which 95 % of its lines rest at both ends on walls that go down, none longer than
/// longest_bridge_mm.
/// O(n log n).
[[nodiscard]] std::vector<Hanging> classify_hanging(
    const decomp::mesh::TriMesh& mesh, const decomp::mesh::Facets& facets,
    const std::vector<std::array<std::int32_t, 3>>& neighbours, const orient::Overhang& overhang,
    const Eigen::Vector3d& down, const HangingOptions& options);

}  // namespace cam::check
