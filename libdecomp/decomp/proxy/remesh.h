// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <cstddef>
#include <optional>

/// Inside the room: the two steps that make a surface coarser. Nothing when the surface is no
/// manifold or a step breaks down.
namespace decomp::proxy {

/// At most about `triangles` triangles, by edge collapse that keeps the volume. The result may
/// intersect itself.
[[nodiscard]] std::optional<mesh::TriMesh> collapsed(const mesh::TriMesh& surface,
                                                     std::size_t triangles);

/// Tunnels narrower than so many edges cannot be meshed well with these edges.
inline constexpr double kNarrowEdges = 2.5;

struct RemeshOptions {
    double edge_mm = 1;
    double sharp_angle_deg = 45;
    /// Lining of tunnels narrower than a few edges gets edges half as long.
    bool fine_tunnels = false;
};

/// Evenly meshed with edges of about edge_mm, points on the input surface. Chains of sharp edges
/// that are longer than a few edges stay.
[[nodiscard]] std::optional<mesh::TriMesh> remeshed(const mesh::TriMesh& surface,
                                                    const RemeshOptions& options);

}  // namespace decomp::proxy
