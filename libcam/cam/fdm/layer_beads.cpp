// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/layer_beads.h"

#include "cam/fdm/infill.h"
#include "cam/fdm/medial.h"
#include "cam/fdm/order.h"
#include "cam/fdm/overhang_walls.h"
#include "cam/fdm/seams.h"
#include "cam/fdm/sparse.h"
#include "cam/fdm/support.h"
#include "cam/fdm/travel.h"
#include "cam/fdm/walls.h"
#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace cam::fdm {

namespace {

using decomp::Angle;
using decomp::Speed;
using path::Bead;
using path::Feature;
using polygon::Paths;
using Process = profile::FdmMachine::Process;

constexpr double kSolidLinkSpacings = 15;  // solid lines are linked over at most so many spacings
// Lines of support under the part, by bead spacings: the thinnest bead does not fall between two.
constexpr double kInterfaceSpacings = 1.25;
constexpr double kLeastWidthNozzles = 0.6;  // narrower beads than that do not come out of a nozzle
constexpr double kLeastDotMm2 = 0.03;       // the least that gets a bead of its own
constexpr double kLeastScrapMm2 = 0.4;      // likewise inside a solid area
constexpr double kFillOverlapRoundings = 1.5;
constexpr double kSunkenFlow = 1.3;       // threads that hang from line to line sag and thin out
constexpr double kCarryingDensity = 0.6;  // infill as dense as that carries a skin like a solid
constexpr double kLeastInternalMm = 1.0;  // half the width of what sags over sparse infill
constexpr double kLeastInternalMm2 = 20;
constexpr double kWidthStepMm = 0.06;  // by which the width of a tapering bead changes

Speed speed_of(Feature feature, const Process& process) {
    switch (feature) {
        case Feature::OuterWall:
            return process.outer_wall_speed;
        case Feature::InnerWall:
            return process.inner_wall_speed;
        case Feature::SparseInfill:
            return process.infill_speed;
        case Feature::Bridge:
            return process.bridge_speed;
        case Feature::Support:
        case Feature::SupportInterface:
            return process.support_speed;
        default:
            return process.solid_speed;
    }
}

/// Only the outer loops: holes filled in.
Paths filled(const Paths& region) {
    Paths outers;
    for (const auto& loop : region) {
        if (polygon::area_mm2(loop) > 0) {
            outers.push_back(loop);
        }
    }
    return polygon::region_of(outers);
}

/// The pieces worth a bead between lines that cover most of the rest.
Paths without_crumbs(const Paths& region) {
    Paths out;
    for (const auto& island : polygon::islands(region)) {
        const Paths loops = island.loops();
        if (polygon::area_mm2(loops) >= kLeastScrapMm2) {
            out.insert(out.end(), loops.begin(), loops.end());
        }
    }
    return out;
}

/// The middle line of something as long as it is wide: along its longer side.
MedialLine middle_of(const Paths& blob) {
    constexpr double kShortestMm = 0.1;
    const polygon::Box box = polygon::bounds(blob);
    const Eigen::Vector2d low = polygon::to_mm(box.min);
    const Eigen::Vector2d size = polygon::to_mm(box.max) - low;
    const int longer = size.x() >= size.y() ? 0 : 1;
    const double width = size[1 - longer];
    Eigen::Vector2d half(0, 0);
    half[longer] = std::max(size[longer] - width, kShortestMm) / 2;
    const Eigen::Vector2d middle = low + size / 2;
    return {{middle - half, width}, {middle + half, width}};
}

/// A line whose ends lie inside the region: led on into the beads beside it, whose round ends leave
/// a gap there.
void lead_on(MedialLine& line, const Paths& region) {
    constexpr double kBackMm = 0.2;  // the direction at an end is that from so far back
    for (const bool front : {true, false}) {
        if (front) {
            std::reverse(line.begin(), line.end());
        }
        const MedialPoint end = line.back();
        const auto back = std::find_if(line.rbegin(), line.rend(), [&](const MedialPoint& p) {
            return (p.at_mm - end.at_mm).norm() >= kBackMm;
        });
        if (back != line.rend()) {
            const Eigen::Vector2d along = (end.at_mm - back->at_mm).normalized();
            const Eigen::Vector2d tip = end.at_mm + end.width_mm * along;
            if (polygon::contains(region, polygon::from_mm(tip))) {
                line.push_back({end.at_mm + end.width_mm / 2 * along, end.width_mm});
            }
        }
        if (front) {
            std::reverse(line.begin(), line.end());
        }
    }
}

class LayerBeads {
  public:
    LayerBeads(const PartLayer& layer, std::size_t index, const PartLayer* below,
               const profile::FdmMachine& machine)
        : layer_(layer),
          index_(index),
          below_(below),
          process_(machine.process),
          least_width_mm_(kLeastWidthNozzles * machine.nozzle.diameter_mm) {}

    std::vector<Bead> beads() {
        if (index_ == 0) {
            add_brim();
        }
        add_support();
        add_part();
        if (below_ != nullptr) {
            out_ = with_overhangs(std::move(out_), below_->slice, process_.overhang_speed);
        }
        const BeadSize& size = layer_.bead;
        find_approaches(
            TravelMap(layer_.slice, size.width_mm, size.width_mm / 2 + size.spacing_mm()), out_);
        return std::move(out_);
    }

  private:
    [[nodiscard]] Bead bead(Feature feature, Line points) const {
        Bead out;
        out.feature = feature;
        out.points = std::move(points);
        out.width_mm = layer_.bead.width_mm;
        out.height_mm = layer_.bead.height_mm;
        out.speed = index_ == 0 ? process_.first_layer_speed : speed_of(feature, process_);
        return out;
    }

    [[nodiscard]] Eigen::Vector2d at() const {
        return out_.empty() ? Eigen::Vector2d(0, 0) : out_.back().points.back();
    }

    void append(std::vector<Bead> beads) {
        std::move(beads.begin(), beads.end(), std::back_inserter(out_));
    }

    // === round the part

    void add_brim() {
        const double spacing = layer_.bead.spacing_mm();
        const int loops = static_cast<int>(std::floor(process_.brim_width_mm / spacing));
        if (loops <= 0) {
            return;
        }
        const Paths foot = filled(polygon::closed(
            polygon::unite(layer_.slice,
                           polygon::unite(layer_.support.body, layer_.support.interface)),
            process_.support_gap_xy_mm));
        for (int i = loops - 1; i >= 0; --i) {
            const double distance = layer_.bead.width_mm / 2 + i * spacing;
            for (Line& loop : closed_lines(polygon::offset(foot, distance, polygon::Join::Round))) {
                out_.push_back(bead(Feature::Brim, std::move(loop)));
            }
        }
    }

    void add_support() {
        std::vector<Bead> beads;
        // The first layer is denser, so that the columns hold on to the bed.
        const double spacing = process_.support_spacing_mm / (index_ == 0 ? 2 : 1);
        add_support_lines(Feature::Support, layer_.support.body, {spacing, Angle(), 2 * spacing},
                          beads);
        const double dense = kInterfaceSpacings * layer_.bead.spacing_mm();
        add_support_lines(Feature::SupportInterface, layer_.support.interface,
                          {dense, Angle::degrees(90), 3 * dense}, beads);
        append(ordered_by_travel(std::move(beads), at()));
    }

    /// Zigzags; places too narrow for lines to stand on get an outline as well.
    void add_support_lines(Feature feature, const Paths& area, const FillPattern& pattern,
                           std::vector<Bead>& beads) const {
        for (const auto& island : polygon::islands(area)) {
            const Paths room = polygon::offset(island.loops(), -layer_.bead.width_mm / 2);
            for (Line& line : fill_with_lines(room, pattern)) {
                beads.push_back(bead(feature, std::move(line)));
            }
            for (Line& loop : closed_lines(between_lines(room, pattern.spacing_mm))) {
                beads.push_back(bead(feature, std::move(loop)));
            }
        }
    }

    // === the part

    void add_part() {
        islands_ = polygon::islands(layer_.slice);
        for (const auto& island : islands_) {
            island_boxes_.push_back(polygon::bounds(island.outer));
        }
        by_island_.resize(islands_.size());
        add_walls();
        add_single_beads(Feature::OuterWall, layer_.walls.thin, 0);
        add_single_beads(Feature::SolidInfill, layer_.walls.gaps, layer_.bead.rounding_mm());
        add_solid();
        add_bridges();
        add_sparse();
        append(
            ordered(std::move(by_island_), at(),
                    seam_place(process_.seam) == SeamPlace::Nearest ? Seams::Free : Seams::Kept));
    }

    IslandBeads& island_of(const Eigen::Vector2d& p) {
        const polygon::Point at = polygon::from_mm(p);
        for (std::size_t i = 0; i + 1 < islands_.size(); ++i) {
            if (polygon::touches(island_boxes_[i], {at, at}) &&
                polygon::contains(islands_[i].loops(), at)) {
                return by_island_[i];
            }
        }
        return by_island_.back();
    }

    void add_walls() {
        for (const Line& loop : layer_.outer_walls) {
            island_of(loop.front()).outer_walls.push_back(bead(Feature::OuterWall, loop));
        }
        for (std::size_t depth = 1; depth < layer_.walls.loops.size(); ++depth) {
            for (Line& loop : closed_lines(layer_.walls.loops[depth])) {
                IslandBeads& island = island_of(loop.front());
                island.inner_walls.push_back(bead(Feature::InnerWall, std::move(loop)));
            }
        }
    }

    /// One bead along the middle of each strip. `rounding_mm` makes up for the round flanks where a
    /// strip lies between other beads.
    void add_single_beads(Feature feature, const Paths& strips, double rounding_mm) {
        for (const auto& island : polygon::islands(polygon::opened(strips, kLeastStripMm / 2))) {
            const Paths strip = island.loops();
            auto lines = medial_lines(strip, kLeastStripMm);
            if (lines.empty() && polygon::area_mm2(strip) >= kLeastDotMm2) {
                lines.push_back(middle_of(strip));
            }
            for (MedialLine& line : lines) {
                if (feature == Feature::OuterWall) {
                    lead_on(line, layer_.slice);
                }
                for (MedialPiece& piece : pieces_of_one_width(line, kWidthStepMm)) {
                    IslandBeads& owner = island_of(piece.points.front());
                    Bead& single = owner.gaps.emplace_back(bead(feature, std::move(piece.points)));
                    single.width_mm = std::max(piece.width_mm + rounding_mm, least_width_mm_);
                }
            }
        }
    }

    /// Line centres keep half a spacing from the area's edge, less what the fill overlaps: walls
    /// leave a gap at the surface by their round flanks, and the fill has to hold on to them.
    [[nodiscard]] double fill_inset_mm() const {
        return layer_.bead.spacing_mm() / 2 - kFillOverlapRoundings * layer_.bead.rounding_mm();
    }

    [[nodiscard]] Paths fill_room(const Paths& area) const {
        return polygon::offset(area, -fill_inset_mm());
    }

    /// @param flow  plastic per plastic that fills the layer
    void add_fill(Feature feature, const Paths& area, const FillPattern& pattern, double flow = 1) {
        const Paths room = fill_room(area);
        const bool seen = feature == Feature::TopSkin;
        for (Line& line : seen ? fill_in_order(room, pattern) : fill_with_lines(room, pattern)) {
            IslandBeads& island = island_of(line.front());
            Bead& one =
                (seen ? island.top : island.fill).emplace_back(bead(feature, std::move(line)));
            one.width_mm += (flow - 1) * layer_.bead.spacing_mm();
        }
        const Paths scraps = polygon::subtract(area, polygon::offset(room, fill_inset_mm()));
        add_single_beads(feature, without_crumbs(scraps), layer_.bead.rounding_mm());
    }

    [[nodiscard]] Feature solid_feature(const Paths& area) const {
        const double half = polygon::area_mm2(area) / 2;
        const auto share = [&](const Paths& open) {
            return open.empty() ? 0 : polygon::area_mm2(polygon::intersect(area, open));
        };
        if (share(layer_.interior.open_to_top) > half) {
            return Feature::TopSkin;
        }
        return index_ == 0 || share(layer_.interior.open_to_bottom) > half ? Feature::BottomSkin
                                                                           : Feature::SolidInfill;
    }

    /// The solid lines of one layer lie across those of the next.
    [[nodiscard]] Angle layer_angle() const {
        return index_ % 2 == 0
                   ? process_.infill_angle
                   : Angle::radians(process_.infill_angle.radians() + Angle::degrees(90).radians());
    }

    void add_solid() {
        const double spacing = layer_.bead.spacing_mm();
        const FillPattern pattern{spacing, layer_angle(), kSolidLinkSpacings * spacing};
        const Paths sunken = over_infill();
        if (!sunken.empty()) {
            add_fill(Feature::Bridge, sunken, pattern, kSunkenFlow);
        }
        for (const auto& island :
             polygon::islands(polygon::subtract(layer_.interior.solid, sunken))) {
            const Paths area = island.loops();
            add_fill(solid_feature(area), area, pattern);
        }
    }

    /// What of the solid area lies over the sparse infill of the layer below, from line to line.
    [[nodiscard]] Paths over_infill() const {
        Paths out;
        if (below_ == nullptr || below_->interior.sparse.empty() ||
            process_.infill_density > kCarryingDensity) {
            return out;
        }
        const Paths over = polygon::opened(
            polygon::intersect(layer_.interior.solid, below_->interior.sparse), kLeastInternalMm);
        for (const auto& island : polygon::islands(over)) {
            const Paths loops = island.loops();
            if (polygon::area_mm2(loops) >= kLeastInternalMm2) {
                out.insert(out.end(), loops.begin(), loops.end());
            }
        }
        return out;
    }

    void add_bridges() {
        const double spacing = layer_.bead.spacing_mm();
        for (const BridgeArea& bridge : layer_.interior.bridges) {
            add_fill(Feature::Bridge, bridge.area,
                     {spacing, bridge.direction, kSolidLinkSpacings * spacing});
        }
    }

    void add_sparse() {
        const bool none = process_.infill_density <= 0 && process_.interface_infill_density <= 0;
        if (none || layer_.interior.sparse.empty()) {
            return;
        }
        const SparseFill fill{sparse_pattern(process_.infill_pattern),
                              process_.infill_density,
                              layer_.bead.spacing_mm(),
                              process_.infill_angle,
                              layer_.top_mm,
                              index_ % 2 != 0,
                              process_.infill_anchor_mm};
        Paths rest = layer_.interior.sparse;
        if (process_.interface_infill_density > fill.density && !layer_.mating.empty()) {
            const double walls = process_.perimeters * layer_.bead.spacing_mm();
            const Paths behind =
                polygon::thickened(layer_.mating, walls + process_.interface_infill_mm);
            SparseFill denser = fill;
            denser.density = process_.interface_infill_density;
            add_sparse_lines(polygon::intersect(rest, behind), denser);
            rest = polygon::subtract(rest, behind);
        }
        add_sparse_lines(rest, fill);
    }

    void add_sparse_lines(const Paths& area, const SparseFill& fill) {
        for (Line& line : fill_sparsely(fill_room(area), fill)) {
            IslandBeads& island = island_of(line.front());
            island.fill.push_back(bead(Feature::SparseInfill, std::move(line)));
        }
    }

    const PartLayer& layer_;
    std::size_t index_;
    const PartLayer* below_;
    const Process& process_;
    double least_width_mm_;
    std::vector<polygon::Island> islands_;
    std::vector<polygon::Box> island_boxes_;
    std::vector<IslandBeads> by_island_;
    std::vector<Bead> out_;
};

}  // namespace

std::vector<Bead> make_beads(const PartLayer& layer, std::size_t index, const PartLayer* below,
                             const profile::FdmMachine& machine) {
    return LayerBeads(layer, index, below, machine).beads();
}

}  // namespace cam::fdm
