// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/render/image.h"

#include <png.h>

#include <string>

namespace tests {

/// The PNG read back by libpng; an image without pixels when it is not a PNG.
inline cam::render::Image decoded(const std::string& bytes) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) {
        return {};
    }
    png.format = PNG_FORMAT_RGB;
    cam::render::Image image(static_cast<int>(png.width), static_cast<int>(png.height), {});
    png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr);
    return image;
}

inline long pixels_unlike(const cam::render::Image& image, cam::render::Rgb colour) {
    long count = 0;
    for (const auto& pixel : image.pixels) {
        count += pixel == colour ? 0 : 1;
    }
    return count;
}

inline long pixels_like(const cam::render::Image& image, cam::render::Rgb colour) {
    return static_cast<long>(image.pixels.size()) - pixels_unlike(image, colour);
}

}  // namespace tests
