// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/image.h"

#include <png.h>

#include <algorithm>
#include <cmath>

namespace cam::render {

namespace {

std::uint8_t mixed_channel(std::uint8_t first, std::uint8_t second, double fraction) {
    const double value = first + (second - first) * fraction;
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

}  // namespace

Rgb mixed(Rgb first, Rgb second, double fraction) {
    return {mixed_channel(first.red, second.red, fraction),
            mixed_channel(first.green, second.green, fraction),
            mixed_channel(first.blue, second.blue, fraction)};
}

Image::Image(int width, int height, Rgb colour)
    : width_px(width),
      height_px(height),
      pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), colour) {}

decomp::Result<std::string> png_bytes(const Image& image) {
    static_assert(sizeof(Rgb) == 3, "libpng reads the pixels as packed bytes");
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width_px);
    png.height = static_cast<png_uint_32>(image.height_px);
    png.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::string bytes(size, '\0');
    const int written =
        png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr);
    if (written == 0) {
        return decomp::fail("render.png", std::string("the picture could not be encoded: ") +
                                              static_cast<const char*>(png.message));
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace cam::render
