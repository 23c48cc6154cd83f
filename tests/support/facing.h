// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/labeling.h"
#include "decomp/mesh/measure.h"
#include "decomp/mesh/tri_mesh.h"

namespace tests {

/// Each triangle labelled by the axis that its normal is nearest to.
inline decomp::labels::Labeling facing(const decomp::mesh::TriMesh& surface) {
    decomp::labels::Labeling labels;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const Eigen::Vector3d normal = decomp::mesh::double_area_normal(surface, t);
        int axis = 0;
        normal.cwiseAbs().maxCoeff(&axis);
        labels.push_back(decomp::labels::label_of(axis, normal[axis] > 0 ? 1 : -1));
    }
    return labels;
}

}  // namespace tests
