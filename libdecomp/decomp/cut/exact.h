// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cut/cells.h"

#include <array>
#include <cstdint>

/// Exact predicates: doubles with an error bound first, then balls, then fractions.
namespace decomp::cut {

/// Two coordinate axes, chosen so that counter-clockwise about the carrier's normal is
/// counter-clockwise in (u, v).
struct Projection {
    int u = 0;
    int v = 1;
};

[[nodiscard]] Projection projection_of(const Cells& cells, Carrier carrier);

/// Sign of normal . x - offset at a vertex.
[[nodiscard]] int side_of_plane(const Cells& cells, std::int32_t vertex, std::int32_t plane);

/// The same for a plane that is not in the table.
[[nodiscard]] int side_of_plane(const Cells& cells, std::int32_t vertex, const part::Plane& plane);

/// Sign of one coordinate of a minus that of b.
[[nodiscard]] int compare_coordinate(const Cells& cells, std::int32_t a, std::int32_t b, int axis);

/// By x, then y, then z; along any line this is an order along the line.
[[nodiscard]] bool lexicographically_less(const Cells& cells, std::int32_t a, std::int32_t b);

/// Sign of the turn a, b, c in the projection: +1 counter-clockwise.
[[nodiscard]] int turn(const Cells& cells, Projection projection, std::int32_t a, std::int32_t b,
                       std::int32_t c);

/// +1 when the fourth vertex lies inside the circle through the first three, given
/// counter-clockwise in the projection; 0 on it.
[[nodiscard]] int in_circle(const Cells& cells, Projection projection,
                            const std::array<std::int32_t, 4>& vertices);

/// Sign of the dot product of the normals of a carrier and a plane.
[[nodiscard]] int compare_directions(const Cells& cells, Carrier carrier, std::int32_t plane);

/// The nearest doubles to the exact coordinates of a vertex.
[[nodiscard]] Eigen::Vector3d rounded_point(const Cells& cells, std::int32_t vertex);

/// True when the three points of an input triangle lie on one line.
[[nodiscard]] bool is_flat(const mesh::TriMesh& mesh, const mesh::Triangle& triangle);

}  // namespace decomp::cut
