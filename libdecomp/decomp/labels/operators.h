// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/energy.h"
#include "decomp/labels/layout.h"

#include <functional>
#include <utility>
#include <vector>

/// Inside the room: changes that may mend what is wrong with a labelling.
namespace decomp::labels {

using FacetLabel = std::pair<std::uint32_t, AxisLabel>;

/// One change: facets that shall get a label, facets that shall not have one.
struct Proposal {
    std::vector<FacetLabel> forced;
    std::vector<FacetLabel> forbidden;
    bool deletes = false;  ///< takes a chart away, rather than shaping or adding one
};

/// What the operators look at.
struct Scene {
    const Energy& energy;
    const Labeling& labels;
    const Layout& layout;
};

/// Takes proposals one by one; false: no more are wanted.
using Consider = std::function<bool(const Proposal&)>;

/// A number of rings that spans about as much at any resolution; `rings` at 3000 facets.
[[nodiscard]] int scaled_rings(const Facets& facets, int rings);

/// For each chart whose loops lack neighbours, largest first: delete it, or insert a disc of a
/// label that it lacks where normals speak for it most, or at its corners.
void propose_for_charts(const Scene& scene, const Consider& consider);

/// For each pair of opposite charts that touch: a strip of a third label between them.
void propose_for_opposites(const Scene& scene, const Consider& consider);

/// For each corner of more than three boundaries: a disc of one of its labels.
void propose_for_corners(const Scene& scene, const Consider& consider);

/// For each turning point: a disc of a label of the third axis or of a chart nearby, or delete a
/// small chart nearby.
void propose_for_turns(const Scene& scene, const Consider& consider);

}  // namespace decomp::labels
