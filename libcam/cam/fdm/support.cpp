// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/support.h"

#include "cam/fdm/bead_size.h"
#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"
#include "decomp/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace cam::fdm {

namespace {

using polygon::Paths;

constexpr double kNoiseMm = 0.005;           // thinner overhangs come from rounding
constexpr double kReachMm = 0.5;             // a column is this much wider than what it carries
constexpr double kIslandReachMm = 1.2;       // under an island, wider
constexpr double kLeastIslandLapMm2 = 0.02;  // less than this on the layer below carries nothing
constexpr double kNarrowMm = 0.4;            // half the least width of a column
constexpr double kTightGapMm =
    0.25;  // beside the part, where the full gap leaves an island no column
constexpr double kSlenderMm2 = 20;    // a column of less section widens downwards …
constexpr double kWideningMm = 0.04;  // … by this much a layer
constexpr double kToleranceMm = 0.05;
constexpr double kTopReachSpacings = 1.2;  // the dense top of a column rests on a line at least
constexpr double kNotchMm =
    1.0;  // notches in a column's outline narrower than twice this are closed
constexpr double kSmoothMm = 0.1;
constexpr double kStandingShare = 0.9;    // of a piece of support, on what is below it
constexpr double kNarrowSpacings = 0.55;  // half the width of what lines of a spacing cannot miss
constexpr double kLeastNarrowMm = 1.0;    // long
constexpr double kLeastNarrowWidthMm = 0.01;  // narrower slivers come from rounding
constexpr double kRoomSlackMm = 0.005;        // so that rounding does not close narrow rooms again
constexpr double kLeastRoomMm2 = 0.05;        // for the centre line of a bead

/// What begins on a layer and needs something below, grown by the reach of its column.
struct Overhang {
    Paths attached;  ///< hangs on the part beside it
    Paths islands;   ///< hangs on nothing
};

/// What of a region gets a bead.
Paths printed(const Paths& region) { return polygon::opened(region, kLeastStripMm / 2); }

/// Whether a piece of a layer has printed material of the layer below under it.
bool lies_on(const Paths& piece, const Paths& below) {
    const Paths lap = polygon::intersect(piece, below);
    const double area = polygon::area_mm2(lap);
    double around = 0;
    for (const auto& loop : lap) {
        around += polygon::perimeter_mm(loop);
    }
    if (area < kLeastIslandLapMm2 || area > around * kLeastStripMm) {
        return area >= kLeastIslandLapMm2;
    }
    return polygon::area_mm2(printed(lap)) >= kLeastIslandLapMm2;
}

Paths grown(const Paths& region, double reach_mm) {
    return polygon::simplified(polygon::offset(region, reach_mm), kToleranceMm);
}

/// @param step_mm  how far a layer may reach beyond the one below; negative: as far as it likes
Overhang overhang_of(const Paths& slice, const Paths& below, const Paths& carried, double step_mm) {
    Overhang out;
    const Paths beyond = polygon::opened(
        polygon::subtract(slice, polygon::offset(below, std::max(step_mm, 0.0))), kNoiseMm);
    if (beyond.empty()) {
        return out;
    }
    for (const polygon::Island& island : polygon::islands(slice)) {
        const Paths loops = island.loops();
        if (!lies_on(loops, below)) {
            out.islands.insert(out.islands.end(), loops.begin(), loops.end());
        }
    }
    if (step_mm >= 0) {
        out.attached =
            grown(polygon::subtract(polygon::subtract(beyond, out.islands), carried), kReachMm);
    }
    out.islands = grown(out.islands, kIslandReachMm);
    return out;
}

std::vector<Overhang> overhangs(const std::vector<Paths>& slices, const std::vector<Paths>& carried,
                                const SupportOptions& options, const decomp::Run& run) {
    // A bead whose middle still lies on the layer below holds by itself.
    const double least = options.line_width_mm / 2;
    const double tangent = std::tan(options.angle.radians());
    const double step = tangent > 0 ? std::max(options.layer_height_mm / tangent, least) : -1;
    std::vector<Overhang> out(slices.size());
    decomp::for_each_index(run, slices.size(), [&](std::size_t i) {
        if (i > 0 && !slices[i].empty()) {
            out[i] = overhang_of(slices[i], slices[i - 1], carried[i], step);
        }
    });
    return out;
}

/// Slender columns, grown.
Paths widened(const Paths& columns) {
    Paths out;
    for (const polygon::Island& island : polygon::islands(columns)) {
        Paths loops = island.loops();
        if (polygon::area_mm2(loops) < kSlenderMm2) {
            loops = polygon::offset(loops, kWideningMm, polygon::Join::Round);
        }
        out = polygon::unite(out, loops);
    }
    return out;
}

/// What has to be carried on one layer, the part and its gap taken away.
struct Columns {
    Paths attached;
    Paths islands;
};

/// The columns, as they come down from layer to layer.
class Descent {
  public:
    Descent(const std::vector<Paths>& slices, const std::vector<Overhang>& overhangs,
            const SupportOptions& options, const decomp::Run& run)
        : slices_(slices),
          overhangs_(overhangs),
          gap_(static_cast<std::size_t>(std::max(options.gap_layers, 0))),
          line_width_mm_(options.line_width_mm),
          spacing_mm_(options.spacing_mm),
          interface_layers_(static_cast<std::size_t>(std::max(options.interface_layers, 0))),
          top_reach_mm_(std::max(options.spacing_mm * kTopReachSpacings - kReachMm, 0.0)),
          run_(run),
          clear_(slices.size()) {
        std::size_t highest = slices.size();
        while (highest > 0 && overhangs[highest - 1].attached.empty() &&
               overhangs[highest - 1].islands.empty()) {
            --highest;
        }
        decomp::for_each_index(run, highest, [&](std::size_t i) {
            clear_[i] =
                polygon::simplified(polygon::offset(slices[i], options.gap_xy_mm), kToleranceMm);
        });
    }

    [[nodiscard]] std::vector<SupportAreas> areas() const {
        std::vector<Columns> columns(slices_.size());
        // The two kinds do not know of each other until they are united.
        decomp::for_each_index(run_, 2, [&](std::size_t kind) {
            Columns now;
            for (std::size_t i = slices_.size(); i-- > 0 && !run_.cancelled();) {
                if (kind == 0) {
                    take_over_attached(i, now.attached);
                    columns[i].attached = now.attached;
                } else {
                    take_over_islands(i, now.islands);
                    columns[i].islands = now.islands;
                }
            }
        });
        std::vector<Paths> whole(slices_.size());
        decomp::for_each_index(run_, columns.size(), [&](std::size_t i) {
            whole[i] = polygon::unite(smooth(columns[i].attached, i), columns[i].islands);
        });
        std::vector<SupportAreas> out(slices_.size());
        decomp::for_each_index(run_, columns.size(), [&](std::size_t i) {
            if (!whole[i].empty()) {
                const Paths above =
                    i + 1 < whole.size() ? under_slender(whole[i + 1], whole[i]) : Paths();
                Paths dense = polygon::unite(contact(i), above);
                dense = polygon::unite(dense, beside_dense(whole[i], dense));
                out[i].interface = with_beads(polygon::intersect(whole[i], dense));
                out[i].body = with_beads(polygon::subtract(whole[i], dense));
            }
        });
        drop_floating(out);
        return out;
    }

  private:
    /// Adds what layer i has to carry, and takes away where the part is.
    void take_over_attached(std::size_t i, Paths& now) const {
        const std::size_t above = i + 1 + gap_;
        if (above < slices_.size() && !overhangs_[above].attached.empty()) {
            now = polygon::unite(now, overhangs_[above].attached);
        }
        if (!now.empty()) {
            now = polygon::simplified(polygon::subtract(now, clear_[i]), kToleranceMm);
        }
    }

    void take_over_islands(std::size_t i, Paths& now) const {
        const std::size_t above = i + 1 + gap_;
        if (above < slices_.size() && !overhangs_[above].islands.empty()) {
            now = polygon::unite(now, overhangs_[above].islands);
        }
        if (!now.empty()) {
            now = beside_part(widened(now), i);
        }
    }

    /// Where beads lie: what has no room for the middle of one is not printed, and carries nothing.
    [[nodiscard]] Paths with_beads(const Paths& area) const {
        Paths room;
        for (const polygon::Island& island :
             polygon::islands(polygon::offset(area, -line_width_mm_ / 2))) {
            const Paths loops = island.loops();
            if (polygon::area_mm2(loops) >= kLeastRoomMm2) {
                room.insert(room.end(), loops.begin(), loops.end());
            }
        }
        return room.empty() ? room : polygon::offset(room, line_width_mm_ / 2 + kRoomSlackMm);
    }

    /// Narrow strips of the body along the dense tops: dense too, since the lines of the layer
    /// below may miss them.
    [[nodiscard]] Paths beside_dense(const Paths& column, const Paths& dense) const {
        Paths out;
        const Paths body = polygon::subtract(column, dense);
        for (const polygon::Island& island : polygon::islands(between_lines(body, spacing_mm_))) {
            const Paths around = polygon::offset(island.loops(), line_width_mm_ / 2);
            if (!polygon::intersect(around, dense).empty()) {
                out = polygon::unite(out, around);
            }
        }
        return out;
    }

    /// Pieces that may fall between two lines of a wider column below them need a dense one there,
    /// which reaches over to lines on either side; so do narrow places of a piece, unless the
    /// column below is as narrow there and has an outline.
    [[nodiscard]] Paths under_slender(const Paths& column, const Paths& below) const {
        Paths out;
        Paths wide;
        for (const polygon::Island& island : polygon::islands(column)) {
            const Paths loops = island.loops();
            Paths& kind = polygon::offset(loops, -spacing_mm_).empty() ? out : wide;
            kind.insert(kind.end(), loops.begin(), loops.end());
        }
        Paths narrow = between_lines(wide, spacing_mm_);
        if (!narrow.empty()) {
            narrow = polygon::opened(polygon::subtract(narrow, between_lines(below, spacing_mm_)),
                                     kNarrowMm / 2);
            out.insert(out.end(), narrow.begin(), narrow.end());
        }
        return out.empty() ? out : polygon::offset(out, top_reach_mm_);
    }

    /// Away from the part where there is room, close to it where there is none.
    [[nodiscard]] Paths beside_part(const Paths& columns, std::size_t i) const {
        Paths out;
        for (const polygon::Island& island : polygon::islands(columns)) {
            const Paths loops = island.loops();
            Paths apart = polygon::opened(polygon::subtract(loops, clear_[i]), kNarrowMm);
            // What stands beside the island that it is for carries little of it.
            const Paths core = polygon::offset(loops, -kIslandReachMm);
            const bool beside =
                polygon::area_mm2(polygon::intersect(core, apart)) < polygon::area_mm2(core) / 2;
            if (apart.empty() || beside) {
                const Paths tight = polygon::offset(slices_[i], kTightGapMm);
                apart = polygon::opened(polygon::subtract(loops, tight), kNarrowMm / 2);
            }
            out = polygon::unite(out, apart);
        }
        return polygon::simplified(out, kToleranceMm);
    }

    /// The attached columns without notches and narrow places, such that lines run well in them.
    [[nodiscard]] Paths smooth(const Paths& attached, std::size_t i) const {
        // Miters: arcs would make the outlines heavy, and lines need no round corners.
        const Paths thick = polygon::simplified(polygon::offset(attached, kNotchMm), kSmoothMm);
        const Paths whole = polygon::simplified(polygon::offset(thick, -kNotchMm), kSmoothMm);
        return polygon::opened(polygon::subtract(whole, clear_[i]), kNarrowMm);
    }

    /// Where a layer's support ends within the next few layers, and as far around that it rests on
    /// lines.
    [[nodiscard]] Paths contact(std::size_t i) const {
        Paths out;
        for (std::size_t k = 1; k <= interface_layers_; ++k) {
            const std::size_t above = i + k + gap_;
            if (above < slices_.size()) {
                const Overhang& o = overhangs_[above];
                out = polygon::unite(out, polygon::unite(o.attached, o.islands));
            }
        }
        return polygon::offset(out, top_reach_mm_);
    }

    /// What of a piece stands on the layer below: all of a piece that mostly does, else what lies
    /// within a bead of it.
    [[nodiscard]] Paths standing(const Paths& piece, const Paths& below) const {
        const double lap = polygon::area_mm2(polygon::intersect(piece, below));
        if (lap >= kStandingShare * polygon::area_mm2(piece)) {
            return piece;
        }
        if (lap < kLeastIslandLapMm2) {
            return {};
        }
        return polygon::intersect(piece, polygon::offset(below, line_width_mm_));
    }

    /// Bottom up: support that stands on nothing, cut off by the gap beside the part, is left out;
    /// a neck to a neighbour that stands does not hold it.
    void drop_floating(std::vector<SupportAreas>& areas) const {
        Paths below = polygon::unite(areas[0].body, areas[0].interface);
        for (std::size_t i = 1; i < areas.size(); ++i) {
            SupportAreas& now = areas[i];
            if (now.body.empty() && now.interface.empty()) {
                below.clear();
                continue;
            }
            const Paths column = polygon::unite(now.body, now.interface);
            const Paths carrying = polygon::unite(below, slices_[i - 1]);
            below.clear();
            for (const polygon::Island& island : polygon::islands(column)) {
                const Paths stands = standing(island.loops(), carrying);
                below.insert(below.end(), stands.begin(), stands.end());
            }
            now.body = with_beads(polygon::intersect(now.body, below));
            now.interface = with_beads(polygon::intersect(now.interface, below));
            below = polygon::unite(now.body, now.interface);
        }
    }

    const std::vector<Paths>& slices_;
    const std::vector<Overhang>& overhangs_;
    std::size_t gap_;
    double line_width_mm_;
    double spacing_mm_;
    std::size_t interface_layers_;
    double top_reach_mm_;  ///< of dense tops beyond what they carry
    const decomp::Run& run_;
    std::vector<Paths> clear_;  ///< the part and the gap beside it, where anything hangs above
};

}  // namespace

Paths between_lines(const Paths& area, double spacing_mm) {
    Paths out;
    if (area.empty()) {
        return out;
    }
    const Paths wide = polygon::opened(area, kNarrowSpacings * spacing_mm);
    for (const polygon::Island& island : polygon::islands(polygon::subtract(area, wide))) {
        const Paths loops = island.loops();
        double around = 0;
        for (const auto& loop : loops) {
            around += polygon::perimeter_mm(loop);
        }
        if (around >= 2 * kLeastNarrowMm &&
            polygon::area_mm2(loops) >= kLeastNarrowWidthMm * around / 2) {
            out.insert(out.end(), loops.begin(), loops.end());
        }
    }
    return out;
}

std::vector<SupportAreas> find_supports(const std::vector<Paths>& slices,
                                        const std::vector<Paths>& carried,
                                        const SupportOptions& options, const decomp::Run& run) {
    const auto hanging = overhangs(slices, carried, options, run);
    const bool any = std::any_of(hanging.begin(), hanging.end(), [](const Overhang& o) {
        return !o.attached.empty() || !o.islands.empty();
    });
    if (!any) {
        return std::vector<SupportAreas>(slices.size());
    }
    return Descent(slices, hanging, options, run).areas();
}

}  // namespace cam::fdm
