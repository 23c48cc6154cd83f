// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sheets/fit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace decomp::sheets {

namespace {

constexpr int kHuberRounds = 3;
constexpr double kHuber = 1.345 * 1.4826;  // of the median distance
constexpr double kNoDistance = 1e-12;

struct Centre {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double weight = 0;
};

Centre centre_of(const std::vector<Sample>& samples, const std::vector<double>& weights) {
    Centre out;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        out.weight += weights[i];
        out.point += weights[i] * samples[i].point;
    }
    out.point /= out.weight > 0 ? out.weight : 1;
    return out;
}

Eigen::Vector3d least_axis(const std::vector<Sample>& samples, const std::vector<double>& weights,
                           const Centre& centre) {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d from = samples[i].point - centre.point;
        spread += weights[i] * from * from.transpose();
    }
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
}

/// Weights fall off beyond a multiple of the median distance.
void reweigh(const std::vector<Sample>& samples, const part::Plane& plane,
             std::vector<double>& weights) {
    std::vector<double> distances;
    distances.reserve(samples.size());
    for (const Sample& sample : samples) {
        distances.push_back(std::abs(plane.normal.dot(sample.point) - plane.offset_mm));
    }
    std::vector<double> sorted = distances;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double limit = kHuber * *middle + kNoDistance;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        weights[i] = samples[i].area_mm2 * std::min(1.0, limit / std::max(distances[i], limit));
    }
}

template <class Normal>
part::Plane fitted(const std::vector<Sample>& samples, const Normal& normal) {
    std::vector<double> weights;
    weights.reserve(samples.size());
    for (const Sample& sample : samples) {
        weights.push_back(sample.area_mm2);
    }
    part::Plane plane;
    for (int round = 0; round <= kHuberRounds; ++round) {
        const Centre centre = centre_of(samples, weights);
        plane.normal = normal(weights, centre);
        plane.offset_mm = plane.normal.dot(centre.point);
        reweigh(samples, plane, weights);
    }
    return plane;
}

}  // namespace

part::Plane fitted_plane(const std::vector<Sample>& samples, const Eigen::Vector3d& towards) {
    return fitted(samples, [&](const std::vector<double>& weights, const Centre& centre) {
        const Eigen::Vector3d normal = least_axis(samples, weights, centre);
        return Eigen::Vector3d(normal.dot(towards) < 0 ? -normal : normal);
    });
}

part::Plane fitted_offset(const std::vector<Sample>& samples, const Eigen::Vector3d& normal) {
    return fitted(samples, [&](const std::vector<double>&, const Centre&) { return normal; });
}

Residual residual(const std::vector<Sample>& samples, const part::Plane& plane) {
    Residual out;
    double weight = 0;
    for (const Sample& sample : samples) {
        const double distance = plane.normal.dot(sample.point) - plane.offset_mm;
        out.rms_mm += sample.area_mm2 * distance * distance;
        out.max_mm = std::max(out.max_mm, std::abs(distance));
        weight += sample.area_mm2;
    }
    out.rms_mm = std::sqrt(out.rms_mm / (weight > 0 ? weight : 1));
    return out;
}

}  // namespace decomp::sheets
