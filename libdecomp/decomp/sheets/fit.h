// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/part/plane.h"

#include <Eigen/Core>

#include <vector>

namespace decomp::sheets {

/// A point of a sheet and the area for which it stands.
struct Sample {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double area_mm2 = 0;
};

/// How far samples lie from a plane.
struct Residual {
    double rms_mm = 0;  ///< weighted by area
    double max_mm = 0;
};

/// The plane that fits best, by weighted principal components and three rounds of Huber's weights.
/// The normal has unit length and points along `towards`.
/// @param samples  not empty
[[nodiscard]] part::Plane fitted_plane(const std::vector<Sample>& samples,
                                       const Eigen::Vector3d& towards);

/// As fitted_plane() for a given unit normal: only the offset is fitted.
[[nodiscard]] part::Plane fitted_offset(const std::vector<Sample>& samples,
                                        const Eigen::Vector3d& normal);

[[nodiscard]] Residual residual(const std::vector<Sample>& samples, const part::Plane& plane);

}  // namespace decomp::sheets
