// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/facets.h"

#include <cstddef>

namespace cam::check {

/// Some facets of a surface: as area, and as their number. Percentages are of the whole surface,
/// whatever is excluded from the count elsewhere, so that the shares of one surface add up.
struct Share {
    double area_mm2 = 0;
    std::size_t facets = 0;
    double by_area_percent = 0;
    double by_facets_percent = 0;
};

/// The share of those facets for which `belongs` holds. O(n), in the order of the facets.
template <class Belongs>
[[nodiscard]] Share share_of(const decomp::mesh::Facets& facets, Belongs belongs) {
    Share share;
    for (std::size_t i = 0; i < facets.area_mm2.size(); ++i) {
        if (belongs(i)) {
            share.area_mm2 += facets.area_mm2[i];
            ++share.facets;
        }
    }
    if (facets.total_mm2 > 0) {
        share.by_area_percent = 100 * share.area_mm2 / facets.total_mm2;
        share.by_facets_percent =
            100.0 * static_cast<double>(share.facets) / static_cast<double>(facets.area_mm2.size());
    }
    return share;
}

}  // namespace cam::check
