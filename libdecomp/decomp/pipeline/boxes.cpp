// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/boxes.h"

#include "decomp/base/number.h"
#include "decomp/partition/partition.h"

#include <algorithm>
#include <array>
#include <utility>

namespace decomp::pipeline {

namespace {

/// Where between the sides of a box it may be divided.
constexpr std::array<double, 7> kShares{0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};

/// Planes across a box along each axis of polycube space, as they lie in the shape.
std::vector<part::Plane> planes_across(const partition::Partition& found, std::int32_t box,
                                       const tets::Lattice& lattice) {
    std::vector<char> wanted;
    for (const std::int32_t owner : found.sheets.box_of_cell) {
        wanted.push_back(owner == box ? 1 : 0);
    }
    const sheets::Box& bounds = found.sheets.boxes[static_cast<std::size_t>(box)];
    std::vector<part::Plane> out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<double>& planes = lattice.planes.at(axis);
        const double low = planes[static_cast<std::size_t>(bounds.low.at(axis))];
        const double high = planes[static_cast<std::size_t>(bounds.high.at(axis))];
        for (const double share : kShares) {
            const auto plane = sheets::mapped_plane(found.cells, wanted, static_cast<int>(axis),
                                                    low + share * (high - low));
            if (plane) {
                out.push_back(*plane);
            }
        }
    }
    return out;
}

BoxFacts facts_of(const partition::Partition& found) {
    const partition::Figures& figures = found.figures;
    BoxFacts out;
    out.boxes = static_cast<int>(found.sheets.boxes.size());
    out.parts = static_cast<int>(found.parts.size());
    out.cuts = figures.cuts;
    out.limited_cuts = figures.limited_cuts;
    out.shifted_cuts = figures.shifted_cuts;
    out.skipped_tongues = figures.skipped_tongues;
    out.healed = figures.healed;
    out.healed_share = figures.healed_share;
    out.mislabeled_share = figures.mislabeled_share;
    out.flipped_share = found.cells.flipped_share;
    out.used = true;
    for (const sheets::Sheet& sheet : found.sheets.sheets) {
        const sheets::SheetPlane& plane =
            found.sheets.planes[static_cast<std::size_t>(sheet.plane)];
        out.sheets.push_back({plane.plane, sheet.axis, sheet.level, plane.snapped, sheet.area_mm2,
                              sheet.residual.rms_mm, sheet.residual.max_mm, sheet.corners});
    }
    return out;
}

/// The sheet that a step of the partition cut along.
std::string decided_by(const cut::Step& step, const sheets::Sheets& sheets) {
    if (step.kind == cut::Step::Kind::Merge) {
        return "one box";
    }
    for (const sheets::SheetPlane& plane : sheets.planes) {
        if (plane.plane.normal == step.plane.normal &&
            plane.plane.offset_mm == step.plane.offset_mm) {
            return std::string("sheet ") + "xyz"[plane.axis] + " " + std::to_string(plane.level);
        }
    }
    return "beside a sheet";
}

}  // namespace

Result<Start> start_from_boxes(const mesh::TriMesh& volume, const DecomposeOptions& options,
                               double nudge_share, Run& run) {
    const PolycubeMap& map = *options.map;
    partition::PartitionOptions how;
    how.nudge_share = nudge_share;
    how.check_rounded = false;
    how.paper = options.mode == Mode::Paper;
    how.sheets.sweep = options.global_sweep ? sheets::Sweep::Global : sheets::Sweep::Local;
    Result<partition::Partition> found =
        partition::partition(volume, map.pair, map.lattice, how, run);
    if (!found) {
        return fail(found.error());
    }
    if (found->figures.mislabeled_share > options.most_mislabeled && !options.keep_boxes) {
        return fail("decompose.bad_map",
                    decimal(100 * found->figures.mislabeled_share, 1) +
                        " % of the polycube lie in the wrong part",
                    "", "try another compactness, or --mode sections");
    }
    Start out(std::move(found->complex));
    out.tier = map.tier;
    for (const cut::Step& step : out.complex.steps()) {
        out.by.push_back(decided_by(step, found->sheets));
    }
    out.keeps_regions = options.keep_boxes;
    out.facts = facts_of(*found);
    for (const partition::BoxPart& part : found->parts) {
        Hints hints;
        for (const sheets::SheetPlane& plane : found->sheets.planes) {
            hints.known.push_back(plane.plane);
        }
        if (part.box >= 0) {
            hints.mapped = planes_across(*found, part.box, map.lattice);
        }
        out.hints.emplace(part.region, std::move(hints));
    }
    return out;
}

}  // namespace decomp::pipeline
