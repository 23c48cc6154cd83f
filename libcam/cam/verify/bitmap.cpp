// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/bitmap.h"

#include <algorithm>
#include <array>

namespace cam::verify {
namespace {

/// One row spread by a pixel to both sides.
void spread(const std::uint64_t* source, std::uint64_t* target, int words) {
    std::uint64_t before = 0;
    for (int w = 0; w < words; ++w) {
        const std::uint64_t here = source[w];
        const std::uint64_t after = w + 1 < words ? source[w + 1] : 0;
        target[w] = here | here << 1U | here >> 1U | before >> 63U | after << 63U;
        before = here;
    }
}

/// Grows by the four neighbours, or by all eight.
void grow(Bitmap& bitmap, bool corners, std::vector<std::uint64_t>& buffer) {
    const int words = bitmap.window().words;
    const int rows = bitmap.window().rows;
    const auto width = static_cast<std::size_t>(words);
    // Three rows as they were: the one below, this one, the one above; plain and spread.
    buffer.assign(6 * width, 0);
    std::array<std::uint64_t*, 3> plain = {&buffer[0], &buffer[width], &buffer[2 * width]};
    std::array<std::uint64_t*, 3> wide = {&buffer[3 * width], &buffer[4 * width],
                                          &buffer[5 * width]};
    const auto load = [&](int row, std::size_t slot) {
        if (row < rows) {
            std::copy_n(bitmap.row_words(row), words, plain[slot]);
            spread(plain[slot], wide[slot], words);
        } else {
            std::fill_n(plain[slot], words, std::uint64_t{0});
            std::fill_n(wide[slot], words, std::uint64_t{0});
        }
    };
    load(0, 1);
    for (int row = 0; row < rows; ++row) {
        load(row + 1, 2);
        const auto& sides = corners ? wide : plain;
        std::uint64_t* target = bitmap.row_words(row);
        for (int w = 0; w < words; ++w) {
            target[w] = wide[1][w] | sides[0][w] | sides[2][w];
        }
        std::rotate(plain.begin(), plain.begin() + 1, plain.end());
        std::rotate(wide.begin(), wide.begin() + 1, wide.end());
    }
}

}  // namespace

void Bitmap::unite(const Bitmap& other) {
    const int shift = (other.window_.left - window_.left) / 64;
    const int first = std::max(0, shift);
    const int last = std::min(window_.words, shift + other.window_.words);
    for (int row = 0; row < window_.rows; ++row) {
        const int other_row = row + window_.bottom - other.window_.bottom;
        if (other_row < 0 || other_row >= other.window_.rows) {
            continue;
        }
        std::uint64_t* to = row_words(row);
        const std::uint64_t* from = other.row_words(other_row);
        for (int w = first; w < last; ++w) {
            to[w] |= from[w - shift];
        }
    }
}

Bitmap dilated(Bitmap bitmap, int radius) {
    std::vector<std::uint64_t> buffer;
    for (int step = 1; step <= radius; ++step) {
        grow(bitmap, step % 3 == 0, buffer);
    }
    return bitmap;
}

}  // namespace cam::verify
