// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/tool/tool.h"

#include "cam/tool/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace cam::tool {

namespace {

constexpr double kSameAngle = 1e-9;   // radians
constexpr double kSameLength = 1e-9;  // mm

constexpr std::array<std::pair<Shape, std::string_view>, 6> kNames = {
    {{Shape::Flat, "flat"},
     {Shape::Ball, "ball"},
     {Shape::BullNose, "bull-nose"},
     {Shape::TaperedBall, "tapered-ball"},
     {Shape::V, "v"},
     {Shape::Drill, "drill"}}};

class Sentences {
  public:
    void must(bool holds, std::string sentence) {
        if (!holds) {
            said_.push_back(std::move(sentence));
        }
    }

    [[nodiscard]] std::vector<std::string> said() && { return std::move(said_); }

  private:
    std::vector<std::string> said_;
};

}  // namespace

std::string_view name_of(Shape shape) {
    for (const auto& [known, name] : kNames) {
        if (known == shape) {
            return name;
        }
    }
    return "";
}

std::optional<Shape> shape_named(std::string_view name) {
    for (const auto& [shape, known] : kNames) {
        if (known == name) {
            return shape;
        }
    }
    return std::nullopt;
}

std::vector<std::string> faults(const Tool& tool) {
    Sentences check;
    const double right_angle = std::numbers::pi / 2;
    check.must(tool.diameter_mm > 0, "the diameter must be above 0");
    check.must(tool.shank_diameter_mm > 0, "the shank's diameter must be above 0");
    check.must(tool.stickout_mm >= tool.flute_mm, "the stickout must hold the whole flute length");
    if (tool.shape == Shape::BullNose) {
        check.must(tool.corner_radius_mm > 0 && tool.corner_radius_mm < tool.radius_mm(),
                   "the corner radius of a bull-nose lies between 0 and half its diameter");
    }
    if (tool.shape == Shape::TaperedBall) {
        check.must(tool.taper.radians() > 0 && tool.taper.radians() < right_angle,
                   "the taper lies between 0 and 90 degrees");
        check.must(tool.tip_diameter_mm > 0 && tool.tip_diameter_mm < tool.diameter_mm,
                   "the ball of a taper is thinner than its flank");
    }
    if (tool.shape == Shape::V) {
        check.must(tool.tip_diameter_mm >= 0 && tool.tip_diameter_mm < tool.diameter_mm,
                   "the tip of a V is thinner than its widest place");
    }
    if (tool.shape == Shape::V || tool.shape == Shape::Drill) {
        check.must(tool.point.radians() > 0 && tool.point.radians() < 2 * right_angle,
                   "the angle of the point lies between 0 and 180 degrees");
    }
    for (const HolderSection& section : tool.holder) {
        check.must(
            section.length_mm > 0 && section.lower_diameter_mm > 0 && section.upper_diameter_mm > 0,
            "the sections of a holder have diameters and a length above 0");
    }
    std::vector<std::string> said = std::move(check).said();
    if (said.empty() &&
        cutter_height_mm(tool, tool.radius_mm()).value_or(0) > tool.flute_mm + kSameLength) {
        said.emplace_back("the flutes end below the widest place of the cutter");
    }
    return said;
}

std::optional<double> cutter_height_mm(const Tool& tool, double r_mm) {
    const Outline outline = outline_of(tool);
    if (!(r_mm <= outline.radius)) {
        return std::nullopt;
    }
    return outline.height(std::max(0.0, r_mm));
}

std::optional<double> shank_height_mm(const Tool& tool, double r_mm, double clearance_mm) {
    if (!(r_mm <= tool.shank_diameter_mm / 2 + clearance_mm)) {
        return std::nullopt;
    }
    return tool.flute_mm;
}

std::optional<double> holder_height_mm(const Tool& tool, double r_mm, double clearance_mm) {
    std::optional<double> lowest;
    double z = tool.stickout_mm - clearance_mm;
    for (const HolderSection& section : tool.holder) {
        const double lower = section.lower_diameter_mm / 2 + clearance_mm;
        const double upper = section.upper_diameter_mm / 2 + clearance_mm;
        std::optional<double> here;
        if (r_mm <= lower) {
            here = z;
        } else if (r_mm <= upper) {
            here = z + section.length_mm * (r_mm - lower) / (upper - lower);
        }
        if (here && (!lowest || *here < *lowest)) {
            lowest = here;
        }
        z += section.length_mm;
    }
    return lowest;
}

double reach_radius_mm(const Tool& tool, double shank_clearance_mm, double holder_clearance_mm) {
    double radius = std::max(tool.radius_mm(), tool.shank_diameter_mm / 2 + shank_clearance_mm);
    for (const HolderSection& section : tool.holder) {
        radius =
            std::max(radius, std::max(section.lower_diameter_mm, section.upper_diameter_mm) / 2 +
                                 holder_clearance_mm);
    }
    return radius;
}

Contact contact(const Tool& tool, decomp::Angle tilt) {
    const Outline outline = outline_of(tool);
    const double angle = std::clamp(tilt.radians(), 0.0, std::numbers::pi / 2);
    if (angle > outline.corner_tilt() - kSameAngle) {
        return {outline.radius, outline.height(outline.radius)};
    }
    return {outline.flat + outline.corner * std::sin(angle),
            outline.corner * (1 - std::cos(angle))};
}

}  // namespace cam::tool
