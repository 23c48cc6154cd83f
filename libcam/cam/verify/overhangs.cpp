// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/overhangs.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cam::verify {
namespace {

constexpr double kStepMm = 0.5;  ///< grown between two looks at what is left
constexpr double kSamePlaceMm = 0.01;
constexpr double kStraight = 0.98;  ///< cosine of the largest bend within a bridge

struct Direction {
    double x = 0;
    double y = 0;
};

Direction direction_of(const Bead& bead) {
    const double length = bead_length(bead);
    return {(bead.x1 - bead.x0) / length, (bead.y1 - bead.y0) / length};
}

bool goes_on(const Bead& a, const Bead& b) {
    const Direction u = direction_of(a);
    const Direction v = direction_of(b);
    return std::abs(a.x1 - b.x0) < kSamePlaceMm && std::abs(a.y1 - b.y0) < kSamePlaceMm &&
           u.x * v.x + u.y * v.y > kStraight;
}

}  // namespace

Bitmap far_from(const Bitmap& hanging, const Bitmap& grounded, const FarFrom& rule,
                double pixel_mm) {
    const int radius = std::max(1, static_cast<int>(std::lround(kStepMm / pixel_mm)));
    const int steps = static_cast<int>(std::ceil(rule.distance_mm / (radius * pixel_mm)));
    Bitmap near = grounded;
    Bitmap far = hanging;
    for (int k = 0; k < steps; ++k) {
        near = dilated(std::move(near), radius);
        for (std::size_t w = 0; w < far.words().size(); ++w) {
            far.words()[w] &= ~near.words()[w];
        }
        if (static_cast<double>(far.count()) * pixel_mm * pixel_mm < rule.enough_mm2) {
            return Bitmap(hanging.window());
        }
    }
    return far;
}

std::vector<char> find_bridges(const std::vector<Bead>& beads, const Levels& levels,
                               const Level& level, const Bitmap& anchors, double pixel_mm) {
    const auto bead = [&](std::uint32_t k) -> const Bead& { return beads[levels.order[k]]; };
    const auto anchored = [&](float x, float y) {
        return anchors.get(static_cast<int>(std::floor(x / pixel_mm)),
                           static_cast<int>(std::floor(y / pixel_mm)));
    };
    std::vector<char> bridges(level.last - level.first, 0);
    for (std::uint32_t k = level.first; k < level.last;) {
        std::uint32_t end = k + 1;
        while (end < level.last && goes_on(bead(end - 1), bead(end))) {
            ++end;
        }
        if (anchored(bead(k).x0, bead(k).y0) && anchored(bead(end - 1).x1, bead(end - 1).y1)) {
            std::fill(bridges.begin() + (k - level.first), bridges.begin() + (end - level.first),
                      1);
        }
        k = end;
    }
    return bridges;
}

}  // namespace cam::verify
