// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/labels/labeling.h"
#include "decomp/mesh/tri_mesh.h"

namespace decomp::labels {

/// How near a labelling is to a polycube's. A chart is a connected set of facets with one label.
struct LabelReport {
    int charts = 0;
    int boundaries = 0;           ///< chains of edges between two charts, corner to corner
    int corners = 0;              ///< vertices where three boundaries or more meet
    int turning_points = 0;       ///< boundaries turn back there by more than 1.5 % of the diagonal
    int invalid_charts = 0;       ///< with a loop that lacks two neighbours along either other axis
    int opposite_boundaries = 0;  ///< boundaries between charts with opposite labels
    int bad_corners = 0;          ///< corners where more than three boundaries meet
    double fidelity = 0;  ///< mean of the normals' components along their labels: 1 on a polycube

    /// Proved to belong to no polycube although locally valid, by the order of labels around
    /// corners (a box inside out, for one). False proves nothing.
    bool impossible = false;

    /// Locally valid: necessary for a polycube of these charts, and in practice nearly enough.
    [[nodiscard]] bool valid() const {
        return invalid_charts == 0 && opposite_boundaries == 0 && bad_corners == 0;
    }
};

/// O(n log n). A surface that is not closed, or labels that do not fit it in number, is a broken
/// precondition: the program stops.
[[nodiscard]] LabelReport report(const mesh::TriMesh& surface, const Labeling& labels);

}  // namespace decomp::labels
