// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/render/image.h"

#include <string_view>

namespace cam::render {

inline constexpr int kLetterWidthPx = 6;   ///< of one letter with its gap, at size 1
inline constexpr int kLetterHeightPx = 7;  ///< at size 1

/// Where a text stands and how big its dots are.
struct Lettering {
    int left_px = 0;
    int top_px = 0;
    int size = 1;  ///< pixels a dot
    Rgb colour;
};

/// Writes capitals of 5 x 7 dots. Letters, digits and "-.:/ "; other characters are left blank.
/// Clipped to the image.
void write(Image& image, std::string_view text, const Lettering& lettering);

}  // namespace cam::render
