// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>

namespace cam::fdm {

/// Width and height of a bead. Side by side, beads lie closer than their width, such that their
/// stadium-shaped sections fill the layer: section = spacing * height.
struct BeadSize {
    double width_mm = 0;
    double height_mm = 0;

    [[nodiscard]] double spacing_mm() const { return width_mm - rounding_mm(); }

    /// What the two round flanks take off a rectangle, as a width.
    [[nodiscard]] double rounding_mm() const { return height_mm * (1.0 - std::numbers::pi / 4.0); }
};

/// Narrower strips than this get no bead, mm.
inline constexpr double kLeastStripMm = 0.12;

}  // namespace cam::fdm
