// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/render/render.h"

#include <Eigen/Core>

#include <cstdint>
#include <memory>

namespace cam::render {

/// What a ray meets first.
struct Hit {
    std::int32_t item = -1;  ///< -1: nothing
    std::uint32_t triangle = 0;
    float distance = 0;
    float u = 0;  ///< weight of the triangle's second corner
    float v = 0;  ///< weight of the third
};

/// The items, centred and scaled into the unit ball, ready for rays. Hides Embree.
class RayScene {
  public:
    /// @error render.device
    [[nodiscard]] static decomp::Result<RayScene> of(const std::vector<Item>& items,
                                                     const Eigen::Vector3d& centre,
                                                     double radius_mm);

    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;
    ~RayScene();

    [[nodiscard]] Hit first_hit(const Eigen::Vector3f& origin,
                                const Eigen::Vector3f& direction) const;

    /// Whether anything lies within `reach` of the origin in this direction.
    [[nodiscard]] bool blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                               float reach) const;

  private:
    struct Handles;
    explicit RayScene(std::unique_ptr<Handles> handles);

    std::unique_ptr<Handles> handles_;
};

}  // namespace cam::render
