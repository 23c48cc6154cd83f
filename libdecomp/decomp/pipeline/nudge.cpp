// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/nudge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace decomp::pipeline {

part::Plane nudged(const part::Plane& plane, const mesh::TriMesh& mesh, double step_mm, int turn) {
    constexpr std::array<int, 9> kSteps{0, 1, -1, 2, -2, 3, -3, 4, -4};
    std::array<double, kSteps.size()> clearance{};
    clearance.fill(std::numeric_limits<double>::infinity());
    for (const Eigen::Vector3d& point : mesh.points) {
        const double height = plane.normal.dot(point) - plane.offset_mm;
        if (std::abs(height) > 6 * step_mm) {
            continue;
        }
        for (std::size_t i = 0; i < kSteps.size(); ++i) {
            clearance.at(i) = std::min(clearance.at(i), std::abs(height - kSteps.at(i) * step_mm));
        }
    }
    std::size_t chosen = kSteps.size();
    for (std::size_t i = 0; i < kSteps.size() && chosen == kSteps.size(); ++i) {
        if (clearance.at(i) > step_mm / 2 && turn-- == 0) {
            chosen = i;
        }
    }
    if (chosen == kSteps.size()) {
        chosen = static_cast<std::size_t>(std::max_element(clearance.begin(), clearance.end()) -
                                          clearance.begin());
    }
    part::Plane out = plane;
    out.offset_mm += kSteps.at(chosen) * step_mm;
    return out;
}

}  // namespace decomp::pipeline
