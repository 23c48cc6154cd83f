// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/labeling.h"
#include "decomp/tets/tet_mesh.h"

#include <cstddef>
#include <span>
#include <string>

namespace decomp::polycube {

/// What a pair is, counted from its coordinates with exact signs; nothing is taken over from
/// whoever made it.
struct PairReport {
    std::size_t tets = 0;
    std::size_t facets = 0;           ///< of the boundary
    std::size_t flips = 0;            ///< tets that are flat or inverted in the polycube
    std::size_t flat_in_shape = 0;    ///< tets without volume in the shape
    double flipped_share = 0;         ///< of the shape's volume
    std::size_t off_axis_facets = 0;  ///< do not lie exactly in a plane of their label
    std::size_t backward_facets = 0;  ///< look against their label, or have no area: the
                                      ///< surface is folded over the edge of its chart
    int charts = 0;
    int corners = 0;              ///< points where three charts or more meet
    int poor_charts = 0;          ///< with fewer than four neighbours
    int opposite_boundaries = 0;  ///< pairs of charts of opposite labels that touch
    int bad_corners = 0;          ///< where more than three charts meet, or two of one axis
    bool overlaps = false;        ///< the polycube's boundary crosses itself; told where no tet is
                                  ///< flipped
    bool identity = false;        ///< the polycube is the shape, moved as a rigid body
    std::string tier;  ///< T1 valid labels, no flip; T2 valid labels; T3 invalid labels, or facets
                       ///< off their planes; T4 identity

    [[nodiscard]] bool labels_valid() const {
        return off_axis_facets == 0 && poor_charts == 0 && opposite_boundaries == 0 &&
               bad_corners == 0;
    }
};

/// Checks a pair. Signs are exact for the coordinates as they are (doubles): a filter, and
/// rationals where it cannot tell. A pair that is mirrored as a whole counts as unflipped.
/// @param labels  of the boundary facets, tet by tet and face by face (boundary order); empty: each
/// facet's own axis and side in the polycube
/// @return nothing but counts; a label list of another length makes every facet off-axis
/// Cost: about 1 us a tet, and the search for crossings of the boundary.
[[nodiscard]] PairReport check_pair(const tets::Pair& pair,
                                    std::span<const labels::AxisLabel> labels);

}  // namespace decomp::polycube
