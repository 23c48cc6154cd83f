// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/envelope.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cam::millproof {

namespace {

constexpr double kBucketMm = 1;
constexpr int kGoldenSteps = 40;
constexpr double kFar = std::numeric_limits<double>::infinity();
/// Below this much rise a step is level.
constexpr double kLevelMm = 1e-9;

double low_z(const Step& step) { return std::min(step.from.z(), step.to.z()); }

}  // namespace

Envelope::Envelope(const std::vector<Step>& steps, const MillJob& job) : steps_(steps), job_(job) {
    origin_ = job.stock.min().head<2>();
    const Eigen::Vector3d size = job.stock.sizes();
    columns_ = static_cast<int>(std::ceil(size.x() / kBucketMm)) + 1;
    rows_ = static_cast<int>(std::ceil(size.y() / kBucketMm)) + 1;
    buckets_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (!steps[i].rapid && steps[i].tool >= 0) {
            enter(i);
        }
    }
    for (Bucket& bucket : buckets_) {
        std::stable_sort(
            bucket.steps.begin(), bucket.steps.end(),
            [&](std::uint32_t a, std::uint32_t b) { return low_z(steps_[a]) < low_z(steps_[b]); });
    }
}

/// Enters a cut into every bucket that its tool may come over.
void Envelope::enter(std::size_t index) {
    const Step& step = steps_[index];
    const double r = job_.tools[static_cast<std::size_t>(step.tool)].tool.radius_mm();
    const Eigen::Vector2d low = step.from.head<2>().cwiseMin(step.to.head<2>()) - origin_;
    const Eigen::Vector2d high = step.from.head<2>().cwiseMax(step.to.head<2>()) - origin_;
    const auto clamped = [](double v, int count) {
        return std::clamp(static_cast<int>(std::floor(v / kBucketMm)), 0, count - 1);
    };
    const Eigen::Vector2d way = (step.to - step.from).head<2>();
    const double length = way.norm();
    for (int row = clamped(low.y() - r, rows_); row <= clamped(high.y() + r, rows_); ++row) {
        for (int column = clamped(low.x() - r, columns_); column <= clamped(high.x() + r, columns_);
             ++column) {
            // Long slanted steps do not fill their box.
            const Eigen::Vector2d centre =
                origin_ + Eigen::Vector2d(column + 0.5, row + 0.5) * kBucketMm;
            const Eigen::Vector2d to_centre = centre - step.from.head<2>();
            const double off =
                length > 0 ? std::abs(way.x() * to_centre.y() - way.y() * to_centre.x()) / length
                           : 0;
            if (off <= r + kBucketMm) {
                buckets_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                         static_cast<std::size_t>(column)]
                    .steps.push_back(static_cast<std::uint32_t>(index));
            }
        }
    }
}

const Envelope::Bucket* Envelope::bucket(const Eigen::Vector2d& at) const {
    const int column = static_cast<int>(std::floor((at.x() - origin_.x()) / kBucketMm));
    const int row = static_cast<int>(std::floor((at.y() - origin_.y()) / kBucketMm));
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) {
        return nullptr;
    }
    return &buckets_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(column)];
}

/// The lowest height of the tool's surface over a point while one step is gone; anything not below
/// `below` may come back as infinity. The height is convex along the step: a cutter's profile is
/// convex and rises with the distance, which itself is convex.
double Envelope::lowest(const Step& step, const Eigen::Vector2d& at, double below) const {
    const tool::Tool& tool = job_.tools[static_cast<std::size_t>(step.tool)].tool;
    const double radius = tool.radius_mm();
    const Eigen::Vector2d way = (step.to - step.from).head<2>();
    const double length2 = way.squaredNorm();
    const Eigen::Vector2d to_point = at - step.from.head<2>();
    const double nearest = length2 > 0 ? std::clamp(way.dot(to_point) / length2, 0.0, 1.0) : 0.0;
    const double d2 = (to_point - way * nearest).squaredNorm();
    if (d2 > radius * radius) {
        return kFar;
    }
    const double lift = tool::cutter_height_mm(tool, std::sqrt(d2)).value_or(kFar);
    if (low_z(step) + lift >= below) {
        return kFar;
    }
    const double rise = step.to.z() - step.from.z();
    if (std::abs(rise) < kLevelMm) {
        return step.from.z() + lift;
    }
    if (!(length2 > 0)) {
        return low_z(step) + lift;
    }
    // Where the step lies within the tool's radius of the point.
    const double along = way.dot(to_point) / length2;
    const double off2 = std::max(0.0, to_point.squaredNorm() - along * along * length2);
    const double half = std::sqrt(std::max(0.0, radius * radius - off2) / length2);
    double a = std::max(0.0, along - half);
    double b = std::min(1.0, along + half);
    const auto height = [&](double t) {
        const double r = std::min(radius, (to_point - way * t).norm());
        return step.from.z() + rise * t + tool::cutter_height_mm(tool, r).value_or(kFar);
    };
    double best = std::min(height(a), height(b));
    constexpr double kGolden = 0.6180339887498949;
    double c = b - kGolden * (b - a);
    double d = a + kGolden * (b - a);
    double at_c = height(c);
    double at_d = height(d);
    for (int i = 0; i < kGoldenSteps; ++i) {
        if (at_c < at_d) {
            b = d;
            d = c;
            at_d = at_c;
            c = b - kGolden * (b - a);
            at_c = height(c);
        } else {
            a = c;
            c = d;
            at_c = at_d;
            d = a + kGolden * (b - a);
            at_d = height(d);
        }
    }
    return std::min({best, at_c, at_d});
}

Envelope::Top Envelope::over(const Eigen::Vector2d& at, double otherwise) const {
    Top top{otherwise, -1};
    if (const Bucket* found = bucket(at)) {
        for (const std::uint32_t index : found->steps) {
            const Step& step = steps_[index];
            if (low_z(step) >= top.z) {
                break;
            }
            const double z = lowest(step, at, top.z);
            if (z < top.z) {
                top = {z, index};
            }
        }
    }
    return top;
}

std::int64_t Envelope::cut_below(const Eigen::Vector3d& at) const {
    std::int64_t first = -1;
    if (const Bucket* found = bucket(at.head<2>())) {
        for (const std::uint32_t index : found->steps) {
            const Step& step = steps_[index];
            if (low_z(step) >= at.z()) {
                break;
            }
            if ((first < 0 || index < first) && lowest(step, at.head<2>(), at.z()) < at.z()) {
                first = index;
            }
        }
    }
    return first;
}

}  // namespace cam::millproof
