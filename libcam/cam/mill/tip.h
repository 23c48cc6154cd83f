// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/height_map.h"
#include "cam/cutter/drop_cutter.h"
#include "cam/cutter/surface.h"
#include "cam/mill/maps.h"
#include "cam/tool/tool.h"

#include <Eigen/Core>

#include <vector>

namespace cam::mill {

inline constexpr double kDip = 0.03;       // mm that a chord may stand over a hollow
inline constexpr double kShortest = 0.02;  // mm in plan: a steeper step is a wall
inline constexpr double kCoarsest = 0.1;   // mm in plan: a hollow is looked at down to here
inline constexpr double kPlaceMm = 0.002;  // to which a level line is moved onto the surface

/// A tool over a surface: exact drops, never below the floor, never where its body would touch.
class Tip {
  public:
    Tip(const cutter::Surface& surface, const tool::Tool& tool, check::HeightMap body,
        double floor);

    [[nodiscard]] double lowest(const Eigen::Vector2d& at, double floor = cutter::kFree) const;

    [[nodiscard]] double body(const Eigen::Vector2d& at) const;

    [[nodiscard]] bool clears(const Eigen::Vector2d& at, double z) const;

    /// Appends the way from a to b (not a itself) over the surface.
    void follow(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                std::vector<Eigen::Vector3d>& out) const;

  private:
    [[nodiscard]] bool cuts_beside_middle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
    void refine(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                std::vector<Eigen::Vector3d>& out) const;

    cutter::DropCutter drop_;
    check::HeightMap body_;
    double floor_;
};

}  // namespace cam::mill
