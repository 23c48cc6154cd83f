// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/settle.h"

#include "decomp/base/parallel.h"
#include "decomp/sections/trial_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace decomp::pipeline {

namespace {

constexpr double kChipShare = 2e-4;  // of the whole volume: too small to be a part
constexpr double kTongue = 0.01;     // of the diagonal: volume / interface
constexpr std::array<double, 13> kShifts{0,      0.001,   -0.001, 0.0025, -0.0025, 0.005, -0.005,
                                         0.0075, -0.0075, 0.012,  -0.012, 0.02,    -0.02};
constexpr int kChipFault = 4;
constexpr int kMisfitFault = 3;
constexpr int kCountFault = 1;

int faults(const part::Part& part, const PlannedCut& cut, const part::Plane& plane,
           const part::Judge& judge, const Whole& root) {
    const auto pieces = sections::trial_cut(part, plane, std::numeric_limits<std::int32_t>::max());
    int sum = pieces.size() > cut.pieces.size() && !cut.pieces.empty() ? kCountFault : 0;
    for (const sections::TrialPiece& piece : pieces) {
        if (piece.volume_mm3 < kChipShare * root.volume_mm3 ||
            piece.bridge_mm < kTongue * root.diagonal_mm) {
            sum += kChipFault;
            continue;
        }
        // The planned piece most like it; a misfit that was to be cut further is none.
        const PlannedPiece* like = nullptr;
        for (const PlannedPiece& planned : cut.pieces) {
            if (planned.above == piece.above &&
                (like == nullptr || std::abs(planned.volume_mm3 - piece.volume_mm3) <
                                        std::abs(like->volume_mm3 - piece.volume_mm3))) {
                like = &planned;
            }
        }
        if (like != nullptr && !like->next && !judge(piece.part, part::Fidelity::Estimate).ok()) {
            sum += kMisfitFault;
        }
    }
    return pieces.size() < 2 ? std::numeric_limits<int>::max() : sum;
}

}  // namespace

part::Plane settled(const part::Part& part, const PlannedCut& cut, const part::Judge& judge,
                    const Whole& root, Run& run) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const mesh::Triangle& t : part.mesh.triangles) {
        for (const std::uint32_t v : t) {
            const double height = cut.plane.normal.dot(part.mesh.points[v]);
            low = std::min(low, height);
            high = std::max(high, height);
        }
    }
    const auto shifted = [&](std::size_t i) {
        return part::Plane{cut.plane.normal, cut.plane.offset_mm + kShifts.at(i) * (high - low)};
    };
    const int unshifted = faults(part, cut, shifted(0), judge, root);
    if (unshifted == 0) {
        return cut.plane;
    }
    std::vector<int> found(kShifts.size(), unshifted);
    for_each_index(run, kShifts.size() - 1, [&](std::size_t i) {
        found[i + 1] = faults(part, cut, shifted(i + 1), judge, root);
    });
    return shifted(
        static_cast<std::size_t>(std::min_element(found.begin(), found.end()) - found.begin()));
}

}  // namespace decomp::pipeline
