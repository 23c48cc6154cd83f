// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/tool/outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cam::tool {

double Outline::corner_tilt() const { return std::numbers::pi / 2 - lean; }

double Outline::corner_end_r() const { return flat + corner * std::cos(lean); }

double Outline::corner_end_z() const { return corner * (1 - std::sin(lean)); }

double Outline::height(double r) const {
    if (r <= flat) {
        return 0;
    }
    const double beyond = r - flat;
    if (beyond <= corner * std::cos(lean)) {
        return corner - std::sqrt(std::max(0.0, corner * corner - beyond * beyond));
    }
    return cone ? corner_end_z() + (r - corner_end_r()) / std::tan(lean) : corner;
}

Outline outline_of(const Tool& tool) {
    const double radius = tool.radius_mm();
    switch (tool.shape) {
        case Shape::Flat:
            return {.flat = radius, .radius = radius};
        case Shape::Ball:
            return {.corner = radius, .radius = radius};
        case Shape::BullNose:
            return {.flat = radius - tool.corner_radius_mm,
                    .corner = tool.corner_radius_mm,
                    .radius = radius};
        case Shape::TaperedBall:
            return {.corner = tool.tip_diameter_mm / 2,
                    .lean = tool.taper.radians(),
                    .cone = true,
                    .radius = radius};
        case Shape::V:
            return {.flat = tool.tip_diameter_mm / 2,
                    .lean = tool.point.radians() / 2,
                    .cone = true,
                    .radius = radius};
        case Shape::Drill:
            return {.lean = tool.point.radians() / 2, .cone = true, .radius = radius};
    }
    return {.flat = radius, .radius = radius};
}

Outline grown(const Outline& outline, double by_mm) {
    Outline out = outline;
    out.corner += by_mm;
    out.radius += by_mm;
    out.z -= by_mm;
    return out;
}

std::vector<Outline> body_outlines(const Tool& tool, double shank_clearance_mm,
                                   double holder_clearance_mm) {
    std::vector<Outline> out;
    const double shank = tool.shank_diameter_mm / 2 + shank_clearance_mm;
    out.push_back({.flat = shank, .radius = shank, .z = tool.flute_mm});
    double z = tool.stickout_mm - holder_clearance_mm;
    for (const HolderSection& section : tool.holder) {
        const double lower = section.lower_diameter_mm / 2 + holder_clearance_mm;
        const double upper = section.upper_diameter_mm / 2 + holder_clearance_mm;
        Outline cone{.flat = lower, .radius = std::max(lower, upper), .z = z};
        if (upper > lower) {
            cone.cone = true;
            cone.lean = std::atan2(upper - lower, section.length_mm);
        }
        out.push_back(cone);
        z += section.length_mm;
    }
    return out;
}

}  // namespace cam::tool
