// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/tool/tool.h"

#include <optional>
#include <vector>

namespace cam::tool {

/// Half of a section through something that turns: a flat or round tip, then a cone, then a
/// cylinder. Convex: the height never falls with the radius, nor does the slope.
///
///          |        cylinder, radius R
///         /         cone, leaning `lean` from the axis
///     (__/          corner of radius `corner`, tangent to the cone, around a flat of radius `flat`
struct Outline {
    double flat = 0;
    double corner = 0;
    double lean = 0;  ///< radians; 0: no cone, the corner runs into the cylinder
    bool cone = false;
    double radius = 0;
    double z = 0;  ///< of the flat's level (or the corner's lowest point) above the tool's tip

    /// Tilt of the surface at which the corner ends.
    [[nodiscard]] double corner_tilt() const;

    [[nodiscard]] double corner_end_r() const;

    /// Above the flat's level.
    [[nodiscard]] double corner_end_z() const;

    /// Above the flat's level, for r <= radius.
    [[nodiscard]] double height(double r) const;
};

/// Of the cutting part.
[[nodiscard]] Outline outline_of(const Tool& tool);

/// The same, thicker by `by_mm` on all sides, tip included: what keeps that distance. Beyond the
/// tool's radius it is a cylinder.
[[nodiscard]] Outline grown(const Outline& outline, double by_mm);

/// Shank and sections of the holder, each grown by its clearance to the sides and below.
[[nodiscard]] std::vector<Outline> body_outlines(const Tool& tool, double shank_clearance_mm,
                                                 double holder_clearance_mm);

}  // namespace cam::tool
