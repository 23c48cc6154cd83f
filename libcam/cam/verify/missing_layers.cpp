// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/missing_layers.h"

#include "cam/verify/limits.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace cam::verify {
namespace {

using decomp::decimal;

constexpr double kSameHeightMm = 0.011;  // a climb so near to a layer is the layer's own
constexpr double kNoTopMm = 1e9;

/// Whether there is something to print: the part of the section that a bead can reach.
bool printable(const Slicer& slicer, double z, double pixel_mm) {
    const Section section = slicer.at(z);
    if (section.bounds.isEmpty()) {
        return false;
    }
    const auto pixel = [&](double at) { return static_cast<int>(std::floor(at / pixel_mm)); };
    const Eigen::AlignedBox2d& box = section.bounds;
    Bitmap inside(Window::around(pixel(box.min().x()), pixel(box.min().y()), pixel(box.max().x()),
                                 pixel(box.max().y())));
    Bitmap rim(inside.window());
    fill_section(section, pixel_mm, inside);
    draw_outline(section, 0.2, pixel_mm, rim);
    std::size_t pixels = 0;
    for (std::size_t w = 0; w < rim.words().size(); ++w) {
        pixels += static_cast<std::size_t>(std::popcount(inside.words()[w] & ~rim.words()[w]));
    }
    return static_cast<double>(pixels) * pixel_mm * pixel_mm >= limits::kPrintableMm2;
}

/// Climbs through the layers of one part.
class PartClimb {
  public:
    PartClimb(const Scene& scene, const Slicer& slicer, std::string id,
              const std::vector<Climb>& climbs, FaultList& faults)
        : slicer_(slicer),
          id_(std::move(id)),
          climbs_(climbs),
          faults_(faults),
          pixel_mm_(scene.pixel_mm),
          below_(slicer.bounds().min().z()) {}

    /// A level on which the part has material.
    void step_to(const Level& level, const LevelReport& report) {
        const double step = level.z - below_;
        const double usual = height_ > 0 ? height_ : report.height_mm;
        if (step > limits::kMissingLayers * usual) {
            const double middle =
                height_ > 0 ? below_ + height_ / 2 : (below_ + level.z - usual) / 2;
            height_ = usual;
            if (printable(slicer_, middle, pixel_mm_)) {
                tell(level.z - usual, line_of_climb(level.z, level.first_line));
            }
        }
        height_ = std::min(report.height_mm, step > 0 ? step : report.height_mm);
        below_ = level.z;
        layer_ = level.layer;
        last_line_ = level.first_line;
    }

    /// After the last level: a missing head, or all of the part.
    void finish() {
        const double top = slicer_.bounds().max().z();
        if (layer_ < 0) {
            if (printable(slicer_, (below_ + top) / 2, pixel_mm_)) {
                faults_.add(
                    {"proof.missing_part", 0, -1, "part " + id_ + " is not made by this program"});
            }
        } else if (top - below_ > (limits::kMissingLayers - 0.5) * height_ &&
                   printable(slicer_, below_ + height_ / 2, pixel_mm_)) {
            tell(top, line_of_climb(kNoTopMm, last_line_));
        }
    }

  private:
    /// The program's first climb from the last layer to below a height, unless it comes later.
    [[nodiscard]] long line_of_climb(double to, long otherwise) const {
        for (const Climb& climb : climbs_) {
            if (climb.z > below_ + kSameHeightMm && climb.z < to - kSameHeightMm &&
                climb.line < otherwise) {
                return static_cast<long>(climb.line);
            }
        }
        return otherwise;
    }

    void tell(double to, long line) {
        faults_.add({"proof.missing_layer", line, layer_ + 1,
                     "part " + id_ + " has no material between z " + decimal(below_, 3) + " and " +
                         decimal(to, 3) + " mm, its layers are " + decimal(height_, 3) +
                         " mm high"});
    }

    const Slicer& slicer_;
    std::string id_;
    const std::vector<Climb>& climbs_;
    FaultList& faults_;
    double pixel_mm_;
    double below_;       ///< height of the last layer
    double height_ = 0;  ///< of the layers
    long last_line_ = 0;
    int layer_ = -1;
};

}  // namespace

void judge_missing_layers(const Scene& scene, const std::vector<LevelReport>& reports,
                          const std::vector<Climb>& climbs,
                          const std::vector<std::string>& part_ids, FaultList& faults) {
    for (std::size_t p = 0; p < scene.slicers->size(); ++p) {
        const Slicer& slicer = (*scene.slicers)[p];
        if (slicer.bounds().isEmpty()) {
            continue;
        }
        PartClimb part(scene, slicer, part_ids[p], climbs, faults);
        for (std::size_t k = 0; k < reports.size(); ++k) {
            if (!reports[k].parts.empty() &&
                reports[k].parts[p].covered_share >= limits::kPresence) {
                part.step_to(scene.levels->levels[k], reports[k]);
            }
        }
        part.finish();
    }
}

}  // namespace cam::verify
