// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/skins.h"

#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"
#include "decomp/base/parallel.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

namespace cam::fdm {

namespace {

using polygon::Paths;

constexpr double kAnchorMm = 1.0;       // skins reach this far into the infill
constexpr double kLeastSparseMm2 = 12;  // smaller patches of infill become solid

/// Intersections of n consecutive layers, for several n, by doubling: few booleans a layer.
class Windows {
  public:
    Windows(const std::vector<Paths>& slices, const decomp::Run& run) : run_(run) {
        by_size_[1] = slices;
    }

    /// Element i is the intersection of layers i … i + n - 1; empty where there are fewer.
    const std::vector<Paths>& of(int n) {
        const auto known = by_size_.find(n);
        if (known != by_size_.end()) {
            return known->second;
        }
        int half = 1;
        while (2 * half < n) {
            half *= 2;
        }
        const auto& low = of(half);
        const auto& high = of(n - half);
        std::vector<Paths> out(low.size());
        decomp::for_each_index(run_, out.size(), [&](std::size_t i) {
            const std::size_t j = i + static_cast<std::size_t>(half);
            if (j < high.size() && !low[i].empty() && !high[j].empty()) {
                out[i] = polygon::intersect(low[i], high[j]);
            }
        });
        return by_size_[n] = std::move(out);
    }

  private:
    const decomp::Run& run_;
    std::map<int, std::vector<Paths>> by_size_;
};

/// Pieces that would lie in a cell of the infill and touch nothing: widened until they rest on
/// lines.
Paths resting(const Paths& solid, const Paths& inside, const SkinOptions& options) {
    Paths out = solid;
    for (const polygon::Island& island : polygon::islands(solid)) {
        const Paths loops = island.loops();
        const bool broad = !polygon::offset(loops, -options.cell_mm / 2).empty();
        if (!broad &&
            polygon::subtract(polygon::offset(loops, options.spacing_mm), inside).empty()) {
            out = polygon::unite(
                out, polygon::intersect(polygon::offset(loops, options.cell_mm / 2), inside));
        }
    }
    return out;
}

/// Solid, widened into the infill, and the infill that is left; what is too narrow or small for
/// infill is solid.
void settle(const Paths& skin, const Paths& inside, const SkinOptions& options, Interior& out) {
    const Paths core = polygon::opened(skin, options.spacing_mm / 4);
    if (core.empty()) {
        out.sparse = inside;
    } else {
        const Paths wide = resting(polygon::offset(core, kAnchorMm), inside, options);
        out.sparse = polygon::opened(polygon::subtract(inside, wide), options.spacing_mm);
    }
    Paths sparse;
    for (const polygon::Island& island : polygon::islands(out.sparse)) {
        const Paths loops = island.loops();
        if (polygon::area_mm2(loops) >= kLeastSparseMm2) {
            sparse.insert(sparse.end(), loops.begin(), loops.end());
        }
    }
    out.sparse = std::move(sparse);
    out.solid = out.sparse.empty() ? inside : polygon::subtract(inside, out.sparse);
}

/// Takes the bridges out of the other areas; solid scraps left beside a bridge join it.
void make_room_for_bridges(Interior& interior) {
    for (BridgeArea& bridge : interior.bridges) {
        interior.solid = polygon::subtract(interior.solid, bridge.area);
        interior.sparse = polygon::subtract(interior.sparse, bridge.area);
    }
    for (BridgeArea& bridge : interior.bridges) {
        constexpr double kTouchMm = 0.01;
        const Paths around = polygon::offset(bridge.area, kTouchMm);
        Paths kept;
        for (const polygon::Island& island : polygon::islands(interior.solid)) {
            const Paths loops = island.loops();
            const bool scrap = polygon::area_mm2(loops) < kLeastSparseMm2 &&
                               !polygon::intersect(loops, around).empty();
            if (scrap) {
                bridge.area = polygon::closed(polygon::unite(bridge.area, loops), kTouchMm);
            } else {
                kept.insert(kept.end(), loops.begin(), loops.end());
            }
        }
        interior.solid = std::move(kept);
    }
}

}  // namespace

std::vector<Interior> split_interiors(const std::vector<Paths>& slices,
                                      const std::vector<Paths>& insides, const SkinOptions& options,
                                      const decomp::Run& run) {
    const int top = std::max(options.top_layers, 0);
    const int bottom = std::max(options.bottom_layers, 0);
    Windows windows(slices, run);
    static const std::vector<Paths> kNoLayers;
    const auto& above = top > 0 ? windows.of(top) : kNoLayers;
    const auto& below = bottom > 0 ? windows.of(bottom) : kNoLayers;
    std::vector<Interior> out(slices.size());
    decomp::for_each_index(run, slices.size(), [&](std::size_t i) {
        const Paths& inside = insides[i];
        Interior& interior = out[i];
        if (inside.empty()) {
            return;
        }
        if (top > 0) {
            interior.open_to_top =
                i + 1 < slices.size() ? polygon::subtract(inside, slices[i + 1]) : inside;
        }
        if (i > 0) {
            interior.open_to_bottom = polygon::subtract(inside, slices[i - 1]);
            interior.bridges = find_bridges(inside, slices[i - 1], options.spacing_mm);
        }
        Paths skin = inside;
        if (!options.all_solid) {
            const auto reach = static_cast<std::size_t>(bottom);
            skin = {};
            if (top > 0) {
                skin = i + 1 < above.size() ? polygon::subtract(inside, above[i + 1]) : inside;
            }
            if (bottom > 0) {
                skin = polygon::unite(
                    skin, i >= reach ? polygon::subtract(inside, below[i - reach]) : inside);
            }
        }
        settle(skin, inside, options, interior);
        make_room_for_bridges(interior);
    });
    return out;
}

}  // namespace cam::fdm
