// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/frame.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <vector>

/// A part about a rotary axis: where it stands, what A shows which side.
namespace cam::check {

/// The smallest cylinder about a direction that holds a shape.
struct Cylinder {
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit length
    Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< point of the axis at the shape's lower end
    double radius_mm = 0;
    double length_mm = 0;
};

/// O(n) in practice (Welzl over the points' shadow). Deterministic.
[[nodiscard]] Cylinder smallest_cylinder(const decomp::mesh::TriMesh& mesh,
                                         const Eigen::Vector3d& axis);

/// The side of the part that faces up at A = 0: the model's up, or X where the axis is upright.
[[nodiscard]] Eigen::Vector3d up_at_zero(const Eigen::Vector3d& axis);

/// Into the set-up frame: the axis along +X through the origin, the shape's lower end at x = 0,
/// `up_at_zero` to +Z.
[[nodiscard]] decomp::Pose<decomp::SetupFrame, decomp::ModelFrame> setup_from_model(
    const Cylinder& cylinder);

/// The direction from the part to the tool, in the set-up frame, that A (radians) turns up: by the
/// A equation Rx(a_sign * A) Z.
[[nodiscard]] Eigen::Vector3d tool_direction(double a_radians, int a_sign);

/// The same for `count` positions of A, evenly from 0 over a turn, in the model frame.
[[nodiscard]] std::vector<Eigen::Vector3d> tool_directions(const Eigen::Vector3d& axis, int count,
                                                           int a_sign);

/// A of position j of `count`, degrees, 0 <= A < 360.
[[nodiscard]] double a_degrees(int position, int count);

}  // namespace cam::check
