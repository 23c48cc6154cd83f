// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/report.h"

#include "decomp/base/assert.h"
#include "decomp/labels/energy.h"
#include "decomp/labels/layout.h"
#include "decomp/labels/order.h"

#include <algorithm>

namespace decomp::labels {

LabelReport report(const mesh::TriMesh& surface, const Labeling& labels) {
    const Result<Facets> facets = facets_of(surface);
    DECOMP_ASSERT(facets && labels.size() == surface.triangles.size());
    const Layout layout = layout_of(*facets, labels);
    LabelReport out;
    out.charts = static_cast<int>(layout.charts.size());
    out.boundaries = static_cast<int>(layout.boundaries.size());
    out.corners = static_cast<int>(layout.corners.size());
    out.turning_points = static_cast<int>(layout.turning_points.size());
    out.invalid_charts = static_cast<int>(
        std::count_if(layout.charts.begin(), layout.charts.end(),
                      [](const Chart& c) { return c.loops == 0 || c.deficiency > 0; }));
    out.opposite_boundaries = static_cast<int>(layout.opposite.size());
    out.bad_corners = static_cast<int>(layout.bad_corners.size());
    out.impossible = impossible(*facets, layout);
    out.fidelity = fidelity(*facets, labels);
    return out;
}

}  // namespace decomp::labels
