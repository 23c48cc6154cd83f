// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/units.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The geometry of rotating tools: values that checkers, planners and proofs share.
///
/// A tool stands on its tip: z = 0 is the tip, z grows towards the spindle, r is the distance from
/// the axis.
///
///        |   holder  |      stickout: tip to the holder's lower end
///        +--+     +--+
///           | sh. |         shank: from the end of the flutes to the holder
///           +-+ +-+
///             | |           flutes: the part that cuts
///             \_/  z = 0
namespace cam::tool {

enum class Shape { Flat, Ball, BullNose, TaperedBall, V, Drill };

/// "flat", "ball", "bull-nose", "tapered-ball", "v", "drill".
[[nodiscard]] std::string_view name_of(Shape shape);

[[nodiscard]] std::optional<Shape> shape_named(std::string_view name);

/// A truncated cone of the holder.
struct HolderSection {
    double lower_diameter_mm = 0;
    double upper_diameter_mm = 0;
    double length_mm = 0;
};

struct Tool {
    std::string name;   ///< the file's stem, e.g. "ball-3"
    std::string title;  ///< for people
    int number = 1;     ///< in the machine's tool table
    Shape shape = Shape::Flat;
    double diameter_mm = 6;       ///< of the cutting part where it is widest
    double corner_radius_mm = 0;  ///< bull-nose only
    double tip_diameter_mm = 0;   ///< tapered ball: of the ball; V: of the flat tip
    decomp::Angle taper;          ///< tapered ball: between axis and flank
    decomp::Angle point;          ///< V and drill: full angle of the cone
    int flutes = 2;               ///< cutting edges
    double flute_mm = 20;         ///< height of the part that cuts
    double shank_diameter_mm = 6;
    double stickout_mm = 30;            ///< from tip to holder
    std::vector<HolderSection> holder;  ///< from its lower end up; empty: nothing is known of it

    [[nodiscard]] double radius_mm() const { return diameter_mm / 2; }
};

/// What contradicts itself in a tool, a sentence each; empty for a sound one.
[[nodiscard]] std::vector<std::string> faults(const Tool& tool);

/// z(r): height of the cutting surface at distance r from the axis, for 0 <= r <= radius_mm();
/// nothing beyond. Never falls with r.
[[nodiscard]] std::optional<double> cutter_height_mm(const Tool& tool, double r_mm);

/// Lowest z at which the shank, grown by a clearance on all sides, is at distance r; nothing where
/// it never is.
[[nodiscard]] std::optional<double> shank_height_mm(const Tool& tool, double r_mm,
                                                    double clearance_mm);

/// The same of the holder.
[[nodiscard]] std::optional<double> holder_height_mm(const Tool& tool, double r_mm,
                                                     double clearance_mm);

/// Largest distance from the axis of anything that belongs to the tool, clearances included.
[[nodiscard]] double reach_radius_mm(const Tool& tool, double shank_clearance_mm,
                                     double holder_clearance_mm);

/// A point of the cutting surface.
struct Contact {
    double r_mm = 0;
    double z_mm = 0;
};

/// Where the tool touches a plane whose upward normal leans by `tilt` from the tool's axis
/// (0: a floor, 90 degrees: a wall). Where it touches along a line (a flat end on a floor, a cone
/// on its own slope), the outermost and uppermost point of it.
[[nodiscard]] Contact contact(const Tool& tool, decomp::Angle tilt);

}  // namespace cam::tool
