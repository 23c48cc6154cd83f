// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/energy.h"

#include <cmath>

namespace decomp::labels {

namespace {

constexpr double kMisfitWidth = 0.2;  // of 1 - cosine; PolyCut's value
constexpr double kBendWidth = 0.25;   // likewise

/// Makes the scale of compactness that of PolyCut on a mesh of 40000 triangles: a unit edge there
/// is sqrt(4 A / (sqrt 3 * 40000)) long and belongs to a unit area A / 40000.
const double kLengthScale = std::sqrt(std::sqrt(3.0) / 4) / std::sqrt(40000.0);

double bell(double x) { return std::exp(-0.5 * x * x); }

double along(const Eigen::Vector3d& normal, int label) {
    const auto l = static_cast<AxisLabel>(label);
    return sign_of(l) * normal[axis_of(l)];
}

}  // namespace

Energy::Energy(const Facets& facets, std::span<const Eigen::Vector3d> normals, double compactness)
    : facets_(facets), misfit_(facets.count()), steps_(facets.count()) {
    const auto count = static_cast<double>(facets.count());
    const double per_length = compactness * kLengthScale * count / std::sqrt(facets.area);
    for (std::uint32_t f = 0; f < facets.count(); ++f) {
        const double weight = facets.areas[f] * count / facets.area;
        for (int l = 0; l < kLabelCount; ++l) {
            misfit_[f].at(static_cast<std::size_t>(l)) =
                weight * (1 - bell((along(normals[f], l) - 1) / kMisfitWidth));
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const double bend =
                (normals[f].dot(normals[facets.neighbours[f].at(k)]) - 1) / kBendWidth;
            steps_[f].at(k) = per_length * facets.edge_length(f, k) * bell(bend);
        }
    }
}

double Energy::of(const Labeling& labels) const {
    double sum = 0;
    for (std::uint32_t f = 0; f < facets_.count(); ++f) {
        sum += misfit_[f].at(static_cast<std::size_t>(labels[f]));
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t g = facets_.neighbours[f].at(k);
            if (f < g && labels[f] != labels[g]) {
                sum += steps_[f].at(k);
            }
        }
    }
    return 100 * sum / static_cast<double>(facets_.count());
}

Labeling nearest_labels(std::span<const Eigen::Vector3d> normals) {
    Labeling labels;
    labels.reserve(normals.size());
    for (const auto& normal : normals) {
        int best = 0;
        for (int l = 1; l < kLabelCount; ++l) {
            best = along(normal, l) > along(normal, best) ? l : best;
        }
        labels.push_back(static_cast<AxisLabel>(best));
    }
    return labels;
}

std::vector<Eigen::Vector3d> smoothed(const Facets& facets, std::vector<Eigen::Vector3d> normals,
                                      int passes) {
    for (int pass = 0; pass < passes; ++pass) {
        std::vector<Eigen::Vector3d> next = normals;
        for (std::uint32_t f = 0; f < facets.count(); ++f) {
            Eigen::Vector3d sum = facets.areas[f] * normals[f];
            for (const auto g : facets.neighbours[f]) {
                sum += facets.areas[g] * normals[g];
            }
            if (sum.norm() > 0) {
                next[f] = sum.normalized();
            }
        }
        normals = std::move(next);
    }
    return normals;
}

double fidelity(const Facets& facets, const Labeling& labels) {
    double sum = 0;
    for (std::uint32_t f = 0; f < facets.count(); ++f) {
        sum += facets.areas[f] * along(facets.normals[f], static_cast<int>(labels[f]));
    }
    return sum / facets.area;
}

}  // namespace decomp::labels
