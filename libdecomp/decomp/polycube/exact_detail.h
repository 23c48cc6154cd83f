// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace decomp::polycube {

/// The sign of (b - a) x (c - a) . (d - a): -1, 0 or 1, exact for the doubles given.
[[nodiscard]] int volume_sign(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                              const Eigen::Vector3d& c, const Eigen::Vector3d& d);

/// The sign of component `axis` of (b - a) x (c - a), exact.
[[nodiscard]] int area_sign(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c, int axis);

}  // namespace decomp::polycube
