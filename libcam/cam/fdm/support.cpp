// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/support.h"

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

constexpr int kInterfaceLayers = 3;
constexpr double kNoiseMm = 0.005;           // thinner overhangs come from rounding
constexpr double kReachMm = 0.5;             // a column is this much wider than what it carries
constexpr double kIslandReachMm = 1.2;       // under an island, wider
constexpr double kLeastIslandLapMm2 = 0.02;  // less than this on the layer below carries nothing
constexpr double kNarrowMm = 0.4;            // half the least width of a column
constexpr double kTightGapMm =
    0.25;  // beside the part, where the full gap leaves an island no column
constexpr double kSlenderMm2 = 20;    // a column of less section widens downwards …
constexpr double kWideningMm = 0.04;  // … by this much a layer
constexpr double kToleranceMm = 0.02;
constexpr double kNotchMm =
    1.0;  // notches in a column's outline narrower than twice this are closed
constexpr double kSmoothMm = 0.1;

/// What begins on a layer and needs something below.
struct Overhang {
    Paths attached;  ///< hangs on the part beside it
    Paths islands;   ///< hangs on nothing
};

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
        if (polygon::area_mm2(polygon::intersect(loops, below)) < kLeastIslandLapMm2) {
            out.islands.insert(out.islands.end(), loops.begin(), loops.end());
        }
    }
    if (step_mm >= 0) {
        out.attached = polygon::subtract(polygon::subtract(beyond, out.islands), carried);
    }
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

/// The columns, as they come down from layer to layer.
class Descent {
  public:
    Descent(const std::vector<Paths>& slices, const std::vector<Overhang>& overhangs,
            const SupportOptions& options, const decomp::Run& run)
        : slices_(slices),
          overhangs_(overhangs),
          gap_(static_cast<std::size_t>(std::max(options.gap_layers, 0))),
          clear_(slices.size()),
          tight_(slices.size()) {
        decomp::for_each_index(run, slices.size(), [&](std::size_t i) {
            clear_[i] =
                polygon::simplified(polygon::offset(slices[i], options.gap_xy_mm), kToleranceMm);
            tight_[i] = polygon::simplified(polygon::offset(slices[i], kTightGapMm), kToleranceMm);
        });
    }

    std::vector<SupportAreas> areas() {
        std::vector<SupportAreas> out(slices_.size());
        for (std::size_t i = slices_.size(); i-- > 0;) {
            take_over(i);
            if (attached_.empty() && islands_.empty()) {
                continue;
            }
            const Paths column = polygon::unite(smooth(i), islands_);
            const Paths top = polygon::intersect(column, contact(i));
            out[i].interface = top;
            out[i].body = polygon::subtract(column, top);
        }
        drop_floating(out);
        return out;
    }

  private:
    /// Adds what layer i has to carry, and takes away where the part is.
    void take_over(std::size_t i) {
        const std::size_t above = i + 1 + gap_;
        if (above < slices_.size()) {
            const Overhang& o = overhangs_[above];
            if (!o.attached.empty()) {
                attached_ = polygon::unite(attached_, polygon::offset(o.attached, kReachMm));
            }
            if (!o.islands.empty()) {
                islands_ = polygon::unite(islands_, polygon::offset(o.islands, kIslandReachMm));
            }
        }
        if (!attached_.empty()) {
            attached_ = polygon::simplified(polygon::subtract(attached_, clear_[i]), kToleranceMm);
        }
        if (!islands_.empty()) {
            // Away from the part where there is room, close to it where there is none.
            Paths columns;
            for (const polygon::Island& island : polygon::islands(widened(islands_))) {
                const Paths loops = island.loops();
                Paths apart = polygon::opened(polygon::subtract(loops, clear_[i]), kNarrowMm);
                if (apart.empty()) {
                    apart = polygon::opened(polygon::subtract(loops, tight_[i]), kNarrowMm / 2);
                }
                columns = polygon::unite(columns, apart);
            }
            islands_ = polygon::simplified(columns, kToleranceMm);
        }
    }

    /// The attached columns without notches and narrow places, such that lines run well in them.
    [[nodiscard]] Paths smooth(std::size_t i) const {
        const Paths whole = polygon::simplified(
            polygon::closed(attached_, kNotchMm, polygon::Join::Round), kSmoothMm);
        return polygon::opened(polygon::subtract(whole, clear_[i]), kNarrowMm,
                               polygon::Join::Round);
    }

    /// Where a layer's support ends within the next few layers.
    Paths contact(std::size_t i) const {
        Paths out;
        for (std::size_t k = 1; k <= kInterfaceLayers; ++k) {
            const std::size_t above = i + k + gap_;
            if (above < slices_.size()) {
                const Overhang& o = overhangs_[above];
                out = polygon::unite(out, polygon::offset(o.attached, kReachMm));
                out = polygon::unite(out, polygon::offset(o.islands, kIslandReachMm));
            }
        }
        return out;
    }

    /// Bottom up: support that stands on nothing, cut off by the gap beside the part, is left out.
    void drop_floating(std::vector<SupportAreas>& areas) const {
        for (std::size_t i = 1; i < areas.size(); ++i) {
            SupportAreas& now = areas[i];
            if (now.body.empty() && now.interface.empty()) {
                continue;
            }
            const Paths rest = polygon::unite(
                polygon::unite(areas[i - 1].body, areas[i - 1].interface), slices_[i - 1]);
            Paths standing;
            for (const polygon::Island& island :
                 polygon::islands(polygon::unite(now.body, now.interface))) {
                const Paths loops = island.loops();
                if (polygon::area_mm2(polygon::intersect(loops, rest)) >= kLeastIslandLapMm2) {
                    standing.insert(standing.end(), loops.begin(), loops.end());
                }
            }
            now.body = polygon::intersect(now.body, standing);
            now.interface = polygon::intersect(now.interface, standing);
        }
    }

    const std::vector<Paths>& slices_;
    const std::vector<Overhang>& overhangs_;
    std::size_t gap_;
    std::vector<Paths> clear_;  ///< the part and the gap beside it
    std::vector<Paths> tight_;
    Paths attached_;
    Paths islands_;
};

}  // namespace

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
