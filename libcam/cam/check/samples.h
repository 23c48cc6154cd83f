// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/share.h"
#include "decomp/mesh/facets.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cam::check {

/// A surface as points that speak for pieces of it: a facet no larger than the spacing is one
/// piece, a larger one is halved along its longest edge until its pieces are.
struct Samples {
    decomp::mesh::Facets pieces;       ///< normals, barycentres and areas of the pieces
    std::vector<std::uint32_t> facet;  ///< to which each belongs, ascending
    double spacing_mm = 0;             ///< no piece has a longer edge
};

struct SampleOptions {
    double spacing_mm = 1;
    std::size_t most_pieces = 100000;  ///< besides the facets; the spacing is doubled to keep it
};

/// @param facets  of the mesh
/// Deterministic, O(facets + pieces).
[[nodiscard]] Samples sample_facets(const decomp::mesh::TriMesh& mesh,
                                    const decomp::mesh::Facets& facets,
                                    const SampleOptions& options);

/// The share of those pieces for which `belongs` holds. As facets count those of which more than
/// half belongs.
template <class Belongs>
[[nodiscard]] Share share_of(const Samples& samples, std::size_t facet_count, Belongs belongs) {
    Share share;
    const auto& area = samples.pieces.area_mm2;
    for (std::size_t first = 0; first < area.size();) {
        double of_facet = 0;
        double all = 0;
        std::size_t i = first;
        for (; i < area.size() && samples.facet[i] == samples.facet[first]; ++i) {
            all += area[i];
            of_facet += belongs(i) ? area[i] : 0;
        }
        share.area_mm2 += of_facet;
        share.facets += of_facet > all / 2 || (all == 0 && belongs(first)) ? 1 : 0;
        first = i;
    }
    if (samples.pieces.total_mm2 > 0) {
        share.by_area_percent = 100 * share.area_mm2 / samples.pieces.total_mm2;
        share.by_facets_percent =
            100.0 * static_cast<double>(share.facets) / static_cast<double>(facet_count);
    }
    return share;
}

/// For each facet whether more than half of it belongs to the marked pieces.
[[nodiscard]] std::vector<char> mostly(const Samples& samples, std::size_t facet_count,
                                       const std::vector<char>& marked);

}  // namespace cam::check
