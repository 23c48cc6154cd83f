// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/units.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

/// The neck between planning and machines for filament printing: semantic moves, no G-code, no E
/// axis.
namespace cam::path {

enum class Feature : std::uint8_t {
    OuterWall,
    InnerWall,
    SolidInfill,
    TopSkin,
    BottomSkin,
    SparseInfill,
    OverhangWall,
    Bridge,
    Support,
    SupportInterface,
    Skirt,
    Brim,
    Prime,
};

/// The word that stands for a feature in reports and in ";TYPE:" comments, e.g. "outer-wall".
[[nodiscard]] const char* feature_name(Feature feature);

/// How the nozzle comes from the end of one bead to the beginning of the next.
struct Approach {
    std::vector<Eigen::Vector2d> by;  ///< way points before the bead's first point, mm
    bool inside = false;  ///< over what is printed in the same layer: what oozes is not seen
};

/// A continuous bead: starts at points.front() and follows the points at one height. A closed loop
/// repeats its first point. The cross-section is that of fdm.md: stadium, area = (width - h (1 -
/// pi/4)) h.
struct Bead {
    Feature feature = Feature::OuterWall;
    std::vector<Eigen::Vector2d> points;  ///< mm, at least two
    double width_mm = 0;
    double height_mm = 0;
    decomp::Speed speed;  ///< wished; cooling may lower it, flow limits may too
    Approach approach;
};

/// Cross-section of a bead, mm^2.
[[nodiscard]] double bead_area_mm2(double width_mm, double height_mm);

/// One layer: its beads in printing order. The travel to a bead goes by its approach; whether
/// filament is retracted for it, `motion` decides.
struct Layer {
    double z_mm = 0;       ///< height of the nozzle = top of the layer
    double height_mm = 0;  ///< of the part's beads; supports may differ
    std::vector<Bead> beads;
    double pause_s = 0;  ///< to wait at its end, off the part, for it to cool
};

/// A part's or a whole plate's layers, bottom up. Frame: PartBedFrame for a part, BedFrame for a
/// plate.
struct LayerStack {
    std::vector<Layer> layers;
};

}  // namespace cam::path
