// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/lies.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace cam::verify {
namespace {

constexpr double kReachMm = 1.2;   ///< how far down a bead looks for what carries it
constexpr double kSampleMm = 0.3;  ///< between two looks along a bead
constexpr int kMostSamples = 64;

class LieFinder {
  public:
    LieFinder(const std::vector<Bead>& beads, const Levels& levels, std::size_t index,
              const std::vector<Bitmap>& below, double pixel_mm)
        : beads_(beads),
          levels_(levels),
          level_(levels.levels[index]),
          below_(below),
          index_(index),
          pixel_mm_(pixel_mm) {}

    Lies find();

  private:
    [[nodiscard]] const Bead& bead(std::uint32_t k) const { return beads_[levels_.order[k]]; }

    [[nodiscard]] double gap_at(double x, double y) const;
    [[nodiscard]] double usual_step_mm() const;
    [[nodiscard]] double usual_height(bool parts, double otherwise) const;

    const std::vector<Bead>& beads_;
    const Levels& levels_;
    const Level& level_;
    const std::vector<Bitmap>& below_;
    std::size_t index_;
    double pixel_mm_;
    std::vector<Lie> lies_;
};

/// Distance down to what lies beneath, from the rough deposits; kReachMm when there is nothing.
double LieFinder::gap_at(double x, double y) const {
    const int i = static_cast<int>(std::floor(x / pixel_mm_));
    const int j = static_cast<int>(std::floor(y / pixel_mm_));
    for (std::size_t k = index_; k-- > 0;) {
        const double gap = level_.z - levels_.levels[k].z;
        if (gap > kReachMm) {
            break;
        }
        if (below_[k].get(i, j)) {
            return gap;
        }
    }
    return std::min(level_.z, kReachMm);
}

/// The step that most layers of parts have: the height of one that hangs over supports alone.
double LieFinder::usual_step_mm() const {
    std::vector<double> steps;
    for (const Level& level : levels_.levels) {
        if (level.layer > 0) {
            steps.push_back(level.step_part);
        }
    }
    if (steps.empty()) {
        return kReachMm;
    }
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return std::min(*middle, kReachMm);
}

Lies LieFinder::find() {
    lies_.resize(level_.last - level_.first);
    for (std::uint32_t k = level_.first; k < level_.last; ++k) {
        const Bead& b = bead(k);
        Lie& lie = lies_[k - level_.first];
        lie.length = bead_length(b);
        lie.area = b.volume_mm3 / lie.length;
        const double strand = strand_diameter(lie.area);
        const int samples = std::clamp(static_cast<int>(lie.length / kSampleMm), 1, kMostSamples);
        double touched = 0;
        int touches = 0;
        for (int s = 0; s < samples; ++s) {
            const double t = (s + 0.5) / samples;
            const double gap = gap_at(b.x0 + t * (b.x1 - b.x0), b.y0 + t * (b.y1 - b.y0));
            if (gap <= strand * 1.05) {
                touched += gap;
                ++touches;
            }
        }
        lie.height = touches > 0 ? touched / touches : 0;
    }
    Lies out;
    out.part_height_mm = usual_height(true, std::min(level_.step_part, usual_step_mm()));
    out.own_height_mm = std::max(
        level_.layer >= 0 ? out.part_height_mm : 0,
        usual_height(false, level_.layer >= 0 ? 0 : std::min(level_.step_other, kReachMm)));
    out.beads = std::move(lies_);
    return out;
}

/// The median by length over the beads of the parts, or over the others: a few beads over a seam or
/// a support must not decide.
double LieFinder::usual_height(bool parts, double otherwise) const {
    double weight = 0;
    std::vector<std::pair<double, double>> heights;
    for (std::uint32_t k = level_.first; k < level_.last; ++k) {
        const Lie& lie = lies_[k - level_.first];
        if ((bead(k).role == Role::Part) == parts && lie.height > 0) {
            heights.emplace_back(lie.height, lie.length);
            weight += lie.length;
        }
    }
    std::sort(heights.begin(), heights.end());
    double sum = 0;
    for (const auto& [height, length] : heights) {
        sum += length;
        if (sum >= weight / 2) {
            return height;
        }
    }
    return otherwise;
}

}  // namespace

Lies find_lies(const std::vector<Bead>& beads, const Levels& levels, std::size_t level,
               const std::vector<Bitmap>& below, double pixel_mm) {
    return LieFinder(beads, levels, level, below, pixel_mm).find();
}

}  // namespace cam::verify
