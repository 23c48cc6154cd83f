// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cam::render {

/// A colour, sRGB, 8 bits a channel.
struct Rgb {
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;

    auto operator<=>(const Rgb&) const = default;
};

/// first at fraction 0, second at fraction 1.
[[nodiscard]] Rgb mixed(Rgb first, Rgb second, double fraction);

/// Rows from the top, pixels from the left.
struct Image {
    int width_px = 0;
    int height_px = 0;
    std::vector<Rgb> pixels;

    Image() = default;
    Image(int width, int height, Rgb colour);

    [[nodiscard]] Rgb& at(int x, int y) { return pixels[index(x, y)]; }

    [[nodiscard]] const Rgb& at(int x, int y) const { return pixels[index(x, y)]; }

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
               static_cast<std::size_t>(x);
    }
};

/// The image as a PNG file, without time or text chunks. @error render.png
[[nodiscard]] decomp::Result<std::string> png_bytes(const Image& image);

}  // namespace cam::render
