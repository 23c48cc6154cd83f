// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/examine_level.h"

#include "cam/verify/holes.h"
#include "cam/verify/islands.h"
#include "cam/verify/lies.h"
#include "cam/verify/limits.h"
#include "cam/verify/overhangs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace cam::verify {
namespace {

constexpr double kMarginMm = 1.0;
constexpr int kBridgeRounds = 3;

class LevelExam {
  public:
    LevelExam(const Scene& scene, std::size_t index, const std::vector<Bitmap>& below)
        : scene_(scene), level_(scene.levels->levels[index]), below_(below), index_(index) {}

    LevelReport run();

  private:
    [[nodiscard]] const Bead& bead(std::uint32_t k) const {
        return (*scene_.beads)[scene_.levels->order[k]];
    }

    void make_window();
    void draw_beads();
    void slice_parts();
    void check_skin();
    void check_outside();
    void check_fill();
    void check_support();
    void find_air(const Bitmap& touched, Bitmap& previous);
    void check_islands(const Bitmap& carried);
    void check_holes();
    [[nodiscard]] double meant_inset_mm() const;
    void check_overhangs(const Bitmap& carried, const Bitmap& previous);
    [[nodiscard]] Bitmap bridges_between(const Bitmap& anchors) const;
    [[nodiscard]] int pixels_of(std::uint32_t k, const Bitmap& in) const;
    template <class Body>
    void rows_of(std::uint32_t k, const Body& body) const;

    [[nodiscard]] double mm2(std::size_t pixels) const {
        return static_cast<double>(pixels) * scene_.pixel_mm * scene_.pixel_mm;
    }

    const Scene& scene_;
    const Level& level_;
    const std::vector<Bitmap>& below_;
    std::size_t index_;
    LevelReport report_;
    Lies lies_;
    std::vector<Section> sections_;
    Window window_;
    Bitmap part_;  ///< undeclared material
    Bitmap all_;
    Bitmap inside_;  ///< union of the sections
};

template <class Body>
void LevelExam::rows_of(std::uint32_t k, const Body& body) const {
    const Bead& b = bead(k);
    const Lie& lie = lies_.beads[k - level_.first];
    const double height = lie.height > 0 ? lie.height : strand_diameter(lie.area);
    for_capsule_rows({b.x0, b.y0, b.x1, b.y1, bead_width(lie.area, height) / 2},
                     GridRows(window_, scene_.pixel_mm), body);
}

/// How much of a bead lies in a bitmap.
int LevelExam::pixels_of(std::uint32_t k, const Bitmap& in) const {
    int pixels = 0;
    rows_of(k, [&](int j, int i0, int i1) { pixels += in.count(j, i0, i1); });
    return pixels;
}

void LevelExam::make_window() {
    window_ = window_of(*scene_.beads, *scene_.levels, index_, scene_.pixel_mm);
    int i0 = window_.left;
    int j0 = window_.bottom;
    int i1 = window_.left + 64 * window_.words - 1;
    int j1 = window_.bottom + window_.rows - 1;
    for (const Section& section : sections_) {
        if (section.bounds.isEmpty()) {
            continue;
        }
        const auto pixel = [&](double at) {
            return static_cast<int>(std::floor(at / scene_.pixel_mm));
        };
        i0 = std::min(i0, pixel(section.bounds.min().x() - kMarginMm));
        j0 = std::min(j0, pixel(section.bounds.min().y() - kMarginMm));
        i1 = std::max(i1, pixel(section.bounds.max().x() + kMarginMm));
        j1 = std::max(j1, pixel(section.bounds.max().y() + kMarginMm));
    }
    window_ = Window::around(i0, j0, i1, j1);
}

void LevelExam::draw_beads() {
    part_ = Bitmap(window_);
    Bitmap other(window_);
    for (std::uint32_t k = level_.first; k < level_.last; ++k) {
        Bitmap& target = bead(k).role == Role::Part ? part_ : other;
        rows_of(k, [&](int j, int i0, int i1) { target.fill(j, i0, i1); });
    }
    all_ = part_;
    all_.unite(other);
    report_.bead_mm2 = mm2(part_.count());
}

void LevelExam::slice_parts() {
    inside_ = Bitmap(window_);
    report_.parts.resize(sections_.size());
    for (std::size_t p = 0; p < sections_.size(); ++p) {
        const Section& section = sections_[p];
        if (section.edges.empty()) {
            continue;
        }
        const auto pixel = [&](double at) {
            return static_cast<int>(std::floor(at / scene_.pixel_mm));
        };
        Bitmap alone(
            Window::around(pixel(section.bounds.min().x()), pixel(section.bounds.min().y()),
                           pixel(section.bounds.max().x()), pixel(section.bounds.max().y())));
        fill_section(section, scene_.pixel_mm, alone);
        std::size_t covered = 0;
        const int column = (alone.window().left - window_.left) / 64;
        for (int row = 0; row < alone.window().rows; ++row) {
            const std::uint64_t* mine = alone.row_words(row);
            const std::uint64_t* beads =
                part_.row_words(row + alone.window().bottom - window_.bottom) + column;
            for (int w = 0; w < alone.window().words; ++w) {
                covered += static_cast<std::size_t>(std::popcount(mine[w] & beads[w]));
            }
        }
        const std::size_t pixels = alone.count();
        report_.parts[p].section_mm2 = mm2(pixels);
        report_.parts[p].covered_share =
            pixels > 0 ? static_cast<double>(covered) / static_cast<double>(pixels) : 0;
        // A section without its material is a missing layer, and judged as one.
        if (report_.parts[p].covered_share >= limits::kPresence) {
            inside_.unite(alone);
        } else {
            sections_[p].edges.clear();
        }
    }
    report_.section_mm2 = mm2(inside_.count());
}

/// How far inside the drawn surface the profile wants the skin; little enough for the ring is none.
double LevelExam::meant_inset_mm() const {
    const auto& process = *scene_.process;
    const bool mates = std::any_of(scene_.mating->begin(), scene_.mating->end(),
                                   [](const Slicer& s) { return !s.bounds().isEmpty(); });
    double inset = std::max({process.outline_inset_mm, process.hole_growth_mm,
                             mates ? process.mating_gap_mm / 2 : 0.0, 0.0});
    inset = inset > limits::kRingOuterMm / 2 ? inset : 0.0;
    return inset + (report_.first ? process.elephant_foot_mm : 0);
}

/// Round holes must be as wide as drawn and as the profile adds.
void LevelExam::check_holes() {
    for (const Section& section : sections_) {
        for (const RoundHole& hole : round_holes(section)) {
            const double meant = hole.diameter_mm + 2 * scene_.process->hole_growth_mm +
                                 (report_.first ? 2 * scene_.process->elephant_foot_mm : 0);
            const double error = free_diameter_mm(hole, inside_, part_, scene_.pixel_mm) - meant;
            ++report_.holes;
            report_.hole_error_mm += error;
            if (std::abs(error) > std::abs(report_.worst_hole_mm)) {
                report_.worst_hole_mm = error;
                report_.worst_hole_at = hole.centre;
            }
        }
    }
}

/// Skin that a bead of the nozzle's width could have covered, 0.1 .. 0.35 mm inside the surface.
void LevelExam::check_skin() {
    const double inset = meant_inset_mm();
    Bitmap outer(window_);
    Bitmap inner(window_);
    for (const Section& section : sections_) {
        draw_outline(section, limits::kRingOuterMm + inset, scene_.pixel_mm, outer);
        // Not deeper than needed: further in lie the gaps between walls.
        draw_outline(section, std::max(limits::kRingInnerMm, limits::kRingOuterMm + inset + 0.1),
                     scene_.pixel_mm, inner);
    }
    // What a disc of 0.2 mm radius inside the part can reach: sharper tips cannot be printed.
    const int radius = static_cast<int>(std::lround(0.2 / scene_.pixel_mm));
    Bitmap core(window_);
    for (const Section& section : sections_) {
        draw_outline(section, 0.2, scene_.pixel_mm, core);
    }
    for (std::size_t w = 0; w < core.words().size(); ++w) {
        core.words()[w] = inside_.words()[w] & ~core.words()[w];
    }
    const Bitmap reachable = dilated(std::move(core), radius);
    std::size_t ring = 0;
    std::size_t uncovered = 0;
    for (std::size_t w = 0; w < inside_.words().size(); ++w) {
        const std::uint64_t skin =
            inside_.words()[w] & inner.words()[w] & ~outer.words()[w] & reachable.words()[w];
        ring += static_cast<std::size_t>(std::popcount(skin));
        uncovered += static_cast<std::size_t>(std::popcount(skin & ~part_.words()[w]));
    }
    report_.ring_mm2 = mm2(ring);
    report_.uncovered_mm2 = mm2(uncovered);
}

void LevelExam::check_outside() {
    Bitmap allowed = inside_;
    for (const Section& section : sections_) {
        draw_outline(section, limits::kOutsideMm + std::max(0.0, -scene_.process->outline_inset_mm),
                     scene_.pixel_mm, allowed);
    }
    std::size_t outside = 0;
    for (std::size_t w = 0; w < allowed.words().size(); ++w) {
        outside += static_cast<std::size_t>(std::popcount(part_.words()[w] & ~allowed.words()[w]));
    }
    report_.outside_mm3 = mm2(outside) * report_.height_mm;
    if (report_.outside_mm3 == 0) {
        return;
    }
    for (std::uint32_t k = level_.first; k < level_.last && report_.outside_line == 0; ++k) {
        if (bead(k).role != Role::Part) {
            continue;
        }
        int pixels = 0;
        rows_of(k, [&](int j, int i0, int i1) {
            pixels += std::max(0, i1 - i0 + 1) - allowed.count(j, i0, i1);
        });
        if (mm2(static_cast<std::size_t>(std::max(0, pixels))) >= 0.05) {
            report_.outside_line = bead(k).line;
        }
    }
}

void LevelExam::check_fill() {
    std::size_t covered = 0;
    for (std::size_t w = 0; w < inside_.words().size(); ++w) {
        covered += static_cast<std::size_t>(std::popcount(inside_.words()[w] & part_.words()[w]));
    }
    const double share = report_.section_mm2 > 0 ? mm2(covered) / report_.section_mm2 : 0;
    // Bridges are thicker than their layer; they say nothing about the flow.
    const double over_nothing = report_.internal_mm2 + report_.air_mm2;
    if (share >= limits::kSolidCoverage && report_.section_mm2 >= limits::kLeastSolidMm2 &&
        over_nothing <= limits::kBridgeShare * report_.bead_mm2) {
        report_.fill = report_.part_mm3 / (report_.section_mm2 * report_.height_mm);
    }
}

void LevelExam::check_support() {
    const double contact =
        lies_.own_height_mm * (1 + limits::kContactLayers) + limits::kContactSlackMm;
    const double touching = report_.height_mm + limits::kContactSlackMm;
    Bitmap carried(window_);
    Bitmap touched(window_);
    for (std::size_t k = index_; k-- > 0;) {
        const double gap = level_.z - scene_.levels->levels[k].z;
        if (gap > contact) {
            break;
        }
        carried.unite(below_[k]);
        if (gap <= touching) {
            touched.unite(below_[k]);
        }
    }
    if (level_.z <= touching) {
        return;  // on the bed
    }
    Bitmap previous(window_);
    find_air(touched, previous);
    std::size_t over_gap = 0;
    for (std::size_t w = 0; w < all_.words().size(); ++w) {
        carried.words()[w] &= all_.words()[w];
        over_gap += static_cast<std::size_t>(std::popcount(
            part_.words()[w] & carried.words()[w] & ~touched.words()[w] & ~previous.words()[w]));
    }
    report_.support_contact_mm2 = mm2(over_gap);
    if (level_.z <= contact) {
        return;  // over the bed by no more than the gap that is allowed
    }
    check_overhangs(carried, previous);
    check_islands(carried);
}

/// Beads over nothing, outside and inside the section of the layer before, which `previous` gets
/// where there are any.
void LevelExam::find_air(const Bitmap& touched, Bitmap& previous) {
    std::size_t air = 0;
    for (std::size_t w = 0; w < all_.words().size(); ++w) {
        air += static_cast<std::size_t>(std::popcount(part_.words()[w] & ~touched.words()[w]));
    }
    if (air == 0) {
        return;
    }
    for (const Slicer& slicer : *scene_.slicers) {
        fill_section(slicer.at(level_.z - 1.5 * report_.height_mm), scene_.pixel_mm, previous);
    }
    std::size_t internal = 0;
    for (std::size_t w = 0; w < all_.words().size(); ++w) {
        internal += static_cast<std::size_t>(
            std::popcount(part_.words()[w] & ~touched.words()[w] & previous.words()[w]));
    }
    report_.internal_mm2 = mm2(internal);
    report_.air_mm2 = mm2(air - internal);
}

/// Islands that rest on nothing, and the first bead of one.
void LevelExam::check_islands(const Bitmap& carried) {
    Bitmap floating(window_);
    const std::vector<Island> islands = find_islands(all_, part_, carried, floating);
    for (const Island& island : islands) {
        if (mm2(island.part_pixels) >= limits::kIslandMm2 ||
            mm2(island.pixels) >= limits::kSupportIslandMm2) {
            ++report_.islands;
            report_.island_mm2 += mm2(island.pixels);
        }
    }
    for (std::uint32_t k = level_.first; report_.islands > 0 && k < level_.last; ++k) {
        if (pixels_of(k, floating) > 3) {
            report_.island_line = bead(k).line;
            break;
        }
    }
}

/// Shelves that stick out over nothing, further than any slope or bridge would explain.
void LevelExam::check_overhangs(const Bitmap& carried, const Bitmap& previous) {
    if (report_.air_mm2 < limits::kHangingMm2) {
        return;
    }
    Bitmap hanging = part_;
    for (std::size_t w = 0; w < hanging.words().size(); ++w) {
        hanging.words()[w] &= ~carried.words()[w] & ~previous.words()[w];
    }
    Bitmap far =
        far_from(hanging, carried, {limits::kHangingMm, limits::kHangingMm2}, scene_.pixel_mm);
    if (far.count() == 0) {
        return;
    }
    // A bead may end on a bridge of the same layer: skin between two bridged walls.
    const int reach = static_cast<int>(std::lround(limits::kAnchorMm / scene_.pixel_mm));
    Bitmap held = carried;
    held.unite(previous);  // over the part below, be it hollow: infill carries an end
    Bitmap anchors = dilated(std::move(held), reach);
    for (int round = 0; round < kBridgeRounds; ++round) {
        const Bitmap bridged = bridges_between(anchors);
        for (std::size_t w = 0; w < far.words().size(); ++w) {
            far.words()[w] &= ~bridged.words()[w];
        }
        anchors.unite(bridged);
    }
    report_.hanging_mm2 = mm2(far.count());
    for (std::uint32_t k = level_.first; k < level_.last && report_.hanging_line == 0; ++k) {
        if (pixels_of(k, far) > 3) {
            report_.hanging_line = bead(k).line;
        }
    }
}

/// The beads that end on anchors at both ends.
Bitmap LevelExam::bridges_between(const Bitmap& anchors) const {
    const std::vector<char> bridges =
        find_bridges(*scene_.beads, *scene_.levels, level_, anchors, scene_.pixel_mm);
    Bitmap bridged(window_);
    for (std::uint32_t k = level_.first; k < level_.last; ++k) {
        if (bridges[k - level_.first] != 0) {
            rows_of(k, [&](int j, int i0, int i1) { bridged.fill(j, i0, i1); });
        }
    }
    return bridged;
}

LevelReport LevelExam::run() {
    report_.first = level_.layer == 0;
    lies_ = find_lies(*scene_.beads, *scene_.levels, index_, below_, scene_.pixel_mm);
    report_.height_mm = lies_.part_height_mm;
    for (std::uint32_t k = level_.first; k < level_.last; ++k) {
        report_.part_mm3 += bead(k).role == Role::Part ? bead(k).volume_mm3 : 0;
    }
    for (const Slicer& slicer : *scene_.slicers) {
        sections_.push_back(slicer.at(level_.z - report_.height_mm / 2));
    }
    make_window();
    draw_beads();
    slice_parts();
    if (level_.layer >= 0 && !sections_.empty()) {
        check_skin();
        check_outside();
        check_holes();
        std::vector<Section> faces;
        for (const Slicer& slicer : *scene_.mating) {
            faces.push_back(slicer.at(level_.z - report_.height_mm / 2));
        }
        report_.seams = count_seams(*scene_.beads, *scene_.levels, level_, faces);
    }
    check_support();
    if (level_.layer >= 0) {
        check_fill();
    }
    return report_;
}

}  // namespace

LevelReport examine_level(const Scene& scene, std::size_t level, const std::vector<Bitmap>& below) {
    return LevelExam(scene, level, below).run();
}

}  // namespace cam::verify
