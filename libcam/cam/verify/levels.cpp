// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/levels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace cam::verify {
namespace {

constexpr double kSameLevelMm = 0.01;
constexpr double kWidestMm = 3;
constexpr double kThinnestMm = 0.04;

/// The step down that matters for a bead: supports may keep heights of their own.
double guessed_height(const Level& level, const Bead& bead, double area) {
    const double step = bead.role == Role::Support ? level.step_other : level.step_part;
    return std::min(std::max(step, kThinnestMm), strand_diameter(area));
}

}  // namespace

int Levels::layer_at(double z) const {
    for (const Level& level : levels) {
        if (level.layer >= 0 && level.z >= z - kSameLevelMm) {
            return level.layer;
        }
    }
    return -1;
}

Levels sort_levels(const std::vector<Bead>& beads) {
    Levels out;
    out.order.resize(beads.size());
    std::iota(out.order.begin(), out.order.end(), 0U);
    std::stable_sort(out.order.begin(), out.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return beads[a].z < beads[b].z; });
    for (std::uint32_t k = 0; k < out.order.size(); ++k) {
        const double z = beads[out.order[k]].z;
        if (out.levels.empty() || z > out.levels.back().z + kSameLevelMm) {
            Level level;
            level.z = z;
            level.first = k;
            out.levels.push_back(level);
        }
        out.levels.back().last = k + 1;
    }
    double part_below = 0;
    double other_below = 0;
    int layer = 0;
    for (Level& level : out.levels) {
        std::sort(out.order.begin() + level.first, out.order.begin() + level.last);
        level.step_part = level.z - part_below;
        level.step_other = level.z - other_below;
        level.first_line = beads[out.order[level.first]].line;
        bool part = false;
        bool other = false;
        for (std::uint32_t k = level.first; k < level.last; ++k) {
            (beads[out.order[k]].role == Role::Part ? part : other) = true;
        }
        if (part) {
            level.layer = layer++;
            part_below = level.z;
        }
        if (other) {
            other_below = level.z;
        }
    }
    return out;
}

double strand_diameter(double area_mm2) { return std::sqrt(area_mm2 * 4 / std::numbers::pi); }

double bead_width(double area_mm2, double height_mm) {
    const double strand = strand_diameter(area_mm2);
    if (height_mm >= strand) {
        return strand;
    }
    const double height = std::max(height_mm, kThinnestMm);
    return std::min(area_mm2 / height + height * (1 - std::numbers::pi / 4), kWidestMm);
}

double bead_length(const Bead& bead) {
    return std::hypot(static_cast<double>(bead.x1) - bead.x0,
                      static_cast<double>(bead.y1) - bead.y0);
}

Bitmap rough_deposit(const std::vector<Bead>& beads, const Levels& levels, std::size_t index,
                     double pixel_mm) {
    const Level& level = levels.levels[index];
    Bitmap bitmap(window_of(beads, levels, index, pixel_mm));
    const GridRows rows(bitmap.window(), pixel_mm);
    for (std::uint32_t k = level.first; k < level.last; ++k) {
        const Bead& bead = beads[levels.order[k]];
        const double area = bead.volume_mm3 / bead_length(bead);
        const double width = bead_width(area, guessed_height(level, bead, area));
        for_capsule_rows({bead.x0, bead.y0, bead.x1, bead.y1, width / 2}, rows,
                         [&](int j, int i0, int i1) { bitmap.fill(j, i0, i1); });
    }
    return bitmap;
}

Window window_of(const std::vector<Bead>& beads, const Levels& levels, std::size_t index,
                 double pixel_mm) {
    const Level& level = levels.levels[index];
    float left = 1e30F;
    float bottom = 1e30F;
    float right = -1e30F;
    float top = -1e30F;
    for (std::uint32_t k = level.first; k < level.last; ++k) {
        const Bead& bead = beads[levels.order[k]];
        left = std::min({left, bead.x0, bead.x1});
        right = std::max({right, bead.x0, bead.x1});
        bottom = std::min({bottom, bead.y0, bead.y1});
        top = std::max({top, bead.y0, bead.y1});
    }
    const double margin = kWidestMm / 2;
    const auto pixel = [&](double at) { return static_cast<int>(std::floor(at / pixel_mm)); };
    return Window::around(pixel(left - margin), pixel(bottom - margin), pixel(right + margin),
                          pixel(top + margin));
}

}  // namespace cam::verify
