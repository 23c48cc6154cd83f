// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/bitmap.h"

#include <algorithm>

namespace cam::verify {
namespace {

/// target |= source spread by `reach` pixels to both sides.
void spread(const std::uint64_t* source, std::uint64_t* target, int words, int reach) {
    for (int w = 0; w < words; ++w) {
        const std::uint64_t here = source[w];
        const std::uint64_t before = w > 0 ? source[w - 1] : 0;
        const std::uint64_t after = w + 1 < words ? source[w + 1] : 0;
        std::uint64_t sum = here;
        if ((here | before | after) != 0) {
            for (int s = 1; s <= reach; ++s) {
                const auto shift = static_cast<unsigned>(s);
                sum |= here << shift | before >> (64U - shift) | here >> shift |
                       after << (64U - shift);
            }
        }
        target[w] |= sum;
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

Bitmap dilated(const Bitmap& bitmap, int radius) {
    Bitmap out(bitmap.window());
    const Window& window = bitmap.window();
    for (int row = 0; row < window.rows; ++row) {
        for (int dy = -radius; dy <= radius; ++dy) {
            const int target = row + dy;
            if (target < 0 || target >= window.rows) {
                continue;
            }
            const int reach =
                static_cast<int>(std::sqrt(static_cast<double>(radius * radius - dy * dy)));
            spread(bitmap.row_words(row), out.row_words(target), window.words, reach);
        }
    }
    return out;
}

}  // namespace cam::verify
