// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/label.h"

#include "decomp/labels/graph_cut.h"
#include "decomp/labels/repair.h"

#include <numeric>
#include <utility>

namespace decomp::labels {

namespace {

constexpr int kMostSmoothing = 20;

Status check(const LabelOptions& options, std::size_t facets, std::size_t normals) {
    if (!(options.compactness > 0 && options.compactness <= 1000) || options.smoothing < 0 ||
        options.smoothing > kMostSmoothing) {
        return fail("labels.options", "compactness or smoothing is outside its range", "",
                    "compactness above 0 (1 to 10 as a rule), smoothing 0 to 20");
    }
    if (normals != 0 && normals != facets) {
        return fail("labels.normals",
                    "there are " + std::to_string(normals) + " normals for " +
                        std::to_string(facets) + " triangles",
                    "", "give one normal for each triangle, or none");
    }
    return {};
}

}  // namespace

Result<Labeling> label(const mesh::TriMesh& surface, std::span<const Eigen::Vector3d> normals,
                       const LabelOptions& options, Run& run) {
    if (auto ok = check(options, surface.triangles.size(), normals.size()); !ok) {
        return fail(ok.error());
    }
    const Result<Facets> facets = facets_of(surface);
    if (!facets) {
        return fail(facets.error());
    }
    if (run.cancelled()) {
        return cancelled();
    }
    std::vector<Eigen::Vector3d> towards =
        normals.empty() ? facets->normals
                        : std::vector<Eigen::Vector3d>(normals.begin(), normals.end());
    towards = smoothed(*facets, std::move(towards), options.smoothing);
    const Energy energy(*facets, towards, options.compactness);
    Labeling labels = nearest_labels(towards);
    std::vector<std::uint32_t> all(facets->count());
    std::iota(all.begin(), all.end(), 0U);
    const std::vector<LabelCosts> no_extra(facets->count(), LabelCosts{});
    lower(energy, no_extra, all, labels);
    if (options.repair == RepairMode::Constructive) {
        labels = repaired(energy, std::move(labels), run);
    } else if (options.repair == RepairMode::Deletion) {
        labels = thinned_out(energy, std::move(labels), run);
    }
    if (run.cancelled()) {
        return cancelled();
    }
    return labels;
}

}  // namespace decomp::labels
