// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/measure.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <limits>

namespace decomp::tets {

namespace {

constexpr double kFlat = 1e-6;          // of the determinant: all but flat, no place in a mean
constexpr double kLeastStretch = 1e-3;  // singular values count as no less

Eigen::Matrix3d edges(std::span<const Eigen::Vector3d> points, const Tet& tet) {
    Eigen::Matrix3d out;
    for (int k = 0; k < 3; ++k) {
        out.col(k) = points[tet.at(static_cast<std::size_t>(k) + 1)] - points[tet[0]];
    }
    return out;
}

}  // namespace

double six_volumes(std::span<const Eigen::Vector3d> points, const Tet& tet) {
    return edges(points, tet).determinant();
}

Eigen::Matrix3d jacobian(const Pair& pair, std::size_t tet) {
    return edges(pair.polycube, pair.tets[tet]) * edges(pair.shape, pair.tets[tet]).inverse();
}

Measures measure(const Pair& pair) {
    Measures out;
    out.tets = pair.tets.size();
    out.least_determinant = std::numeric_limits<double>::infinity();
    double flipped = 0;
    double kept = 0;
    for (std::size_t i = 0; i < pair.tets.size(); ++i) {
        const double volume = six_volumes(pair.shape, pair.tets[i]) / 6;
        const double mapped = six_volumes(pair.polycube, pair.tets[i]) / 6;
        out.volume_mm3 += volume;
        out.polycube_mm3 += mapped;
        if (!(volume > 0)) {
            continue;
        }
        out.least_determinant = std::min(out.least_determinant, mapped / volume);
        if (!(mapped > 0)) {
            ++out.flips;
            flipped += volume;
            continue;
        }
        if (mapped < kFlat * volume) {
            continue;
        }
        const Eigen::Matrix3d j = jacobian(pair, i);
        const Eigen::Vector3d stretch = j.jacobiSvd().singularValues().cwiseMax(kLeastStretch);
        kept += volume;
        out.symmetric_dirichlet +=
            volume * (stretch.squaredNorm() + stretch.cwiseInverse().squaredNorm()) / 6;
    }
    if (kept > 0) {
        out.symmetric_dirichlet /= kept;
    }
    if (out.volume_mm3 > 0) {
        out.flipped_share = flipped / out.volume_mm3;
    }
    return out;
}

}  // namespace decomp::tets
