// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/render/render.h"

#include <Eigen/Geometry>

namespace cam::render {

/// An orthographic camera: three orthonormal directions in the frame of the items.
struct Camera {
    Eigen::Vector3d right;
    Eigen::Vector3d up;
    Eigen::Vector3d toward_viewer;
};

[[nodiscard]] Camera camera(View view);

/// What the picture has to hold: bounds in camera axes (right, up, toward viewer), mm.
[[nodiscard]] Eigen::AlignedBox3d bounds_seen(const std::vector<Item>& items, const Camera& camera);

[[nodiscard]] double fitted_scale_px_per_mm(const Eigen::AlignedBox3d& seen,
                                            const ViewOptions& options);

/// @error render.size
[[nodiscard]] decomp::Status check_size(int width_px, int height_px);

}  // namespace cam::render
