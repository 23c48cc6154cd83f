// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/decimate.h"

#include "decomp/mesh/measure.h"
#include "decomp/repair/distance.h"
#include "decomp/solid/collapse.h"

#include <algorithm>
#include <utility>

namespace decomp::solid {

namespace {

constexpr int kTries = 4;
constexpr double kTighter = 0.8;
/// Of the tolerance, for what lies between the points that are watched.
constexpr double kWatched = 0.85;

Decimated compacted(const part::Part& part, const Regions& regions, const Collapsed& collapsed) {
    Decimated out;
    out.part.id = part.id;
    std::vector<std::uint32_t> number(part.mesh.points.size(), UINT32_MAX);
    for (std::size_t t = 0; t < collapsed.triangles.size(); ++t) {
        if (!collapsed.alive[t]) {
            continue;
        }
        mesh::Triangle triangle = collapsed.triangles[t];
        for (std::uint32_t& corner : triangle) {
            if (number[corner] == UINT32_MAX) {
                number[corner] = static_cast<std::uint32_t>(out.part.mesh.points.size());
                out.part.mesh.points.push_back(part.mesh.points[corner]);
            }
            corner = number[corner];
        }
        out.part.mesh.triangles.push_back(triangle);
        out.region_of.push_back(regions.of[t]);
        if (!part.sources.empty()) {
            out.part.sources.push_back(part.sources[t]);
        }
    }
    out.removed_points = collapsed.removed_points;
    return out;
}

/// Flat regions of a few triangles, of which a rounded surface may consist altogether, would fix
/// every point: they are triangles again while triangles are joined.
Regions without_small_flats(const part::Part& part, const Regions& regions) {
    constexpr int kFew = 4;
    Regions out = regions;
    std::vector<int> size(regions.all.size(), 0);
    std::vector<bool> cut(regions.all.size(), false);
    for (std::size_t t = 0; t < regions.of.size(); ++t) {
        if (regions.of[t] >= 0) {
            const auto r = static_cast<std::size_t>(regions.of[t]);
            ++size[r];
            cut[r] = !part.sources.empty() && part.sources[t].is_cut();
        }
    }
    for (std::int32_t& r : out.of) {
        if (r >= 0 && size[static_cast<std::size_t>(r)] <= kFew &&
            !cut[static_cast<std::size_t>(r)] &&
            std::holds_alternative<PlaneSurface>(
                regions.all[static_cast<std::size_t>(r)].surface)) {
            r = -1;
        }
    }
    return out;
}

}  // namespace

Result<Decimated> decimate(const part::Part& part, const Adjacency& adjacency,
                           const Regions& all_regions, const DecimateOptions& options,
                           const Run& run) {
    const Regions regions = without_small_flats(part, all_regions);
    double watched_mm = kWatched * options.tolerance_mm;
    Decimated best;
    for (int attempt = 0; attempt < kTries; ++attempt) {
        const auto collapsed =
            collapse(part, adjacency, regions, watched_mm, options.max_faces, run);
        if (!collapsed) {
            return fail(collapsed.error());
        }
        best = compacted(part, all_regions, *collapsed);
        // The watch is kept on what was removed; what was made in its place is measured here.
        best.farthest_mm = std::max(repair::farthest_mm(best.part.mesh, part.mesh),
                                    repair::farthest_mm(part.mesh, best.part.mesh));
        if (best.farthest_mm <= options.tolerance_mm) {
            return best;
        }
        watched_mm *= kTighter;
    }
    // Nothing that was joined stays within the tolerance: the mesh as it came does.
    best.part = part;
    best.region_of = all_regions.of;
    best.removed_points = 0;
    best.farthest_mm = 0;
    return best;
}

}  // namespace decomp::solid
