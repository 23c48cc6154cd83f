// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace decomp::labels {

/// The side of the polycube that a facet will lie on. The numbers are those of the label files that
/// polycube programs exchange: +X, -X, +Y, -Y, +Z, -Z.
enum class AxisLabel : std::uint8_t { PlusX, MinusX, PlusY, MinusY, PlusZ, MinusZ };

inline constexpr int kLabelCount = 6;

/// 0, 1, 2 for X, Y, Z.
[[nodiscard]] constexpr int axis_of(AxisLabel label) { return static_cast<int>(label) / 2; }

/// +1 or -1.
[[nodiscard]] constexpr int sign_of(AxisLabel label) {
    return static_cast<int>(label) % 2 == 0 ? 1 : -1;
}

[[nodiscard]] constexpr AxisLabel label_of(int axis, int sign) {
    return static_cast<AxisLabel>(2 * axis + (sign > 0 ? 0 : 1));
}

[[nodiscard]] constexpr AxisLabel opposite(AxisLabel label) {
    return label_of(axis_of(label), -sign_of(label));
}

/// One label for each triangle of a surface.
using Labeling = std::vector<AxisLabel>;

}  // namespace decomp::labels
