// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/bitmap.h"

#include <cstdint>
#include <vector>

namespace cam::verify {

/// A connected patch of a level that rests on nothing.
struct Island {
    std::size_t pixels = 0;
    std::size_t part_pixels = 0;  ///< of them, those of the part
    int i = 0;                    ///< one of its pixels: the first of its lowest row
    int j = 0;
};

/// Connected components (by edges and corners) of `deposit` without a pixel in `carried`, with
/// their pixels drawn into `floating`. `part` is the part's share of the deposit. O(runs).
[[nodiscard]] std::vector<Island> find_islands(const Bitmap& deposit, const Bitmap& part,
                                               const Bitmap& carried, Bitmap& floating);

}  // namespace cam::verify
