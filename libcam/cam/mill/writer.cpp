// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/writer.h"

#include <algorithm>
#include <utility>

namespace cam::mill {

using Eigen::Vector3d;

namespace {

constexpr double kSamePoint = 1e-4;  // mm: below what a program can say

double distance_to(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
    const Vector3d along = b - a;
    const double length = along.squaredNorm();
    const double share = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0;
    return (p - a - share * along).norm();
}

}  // namespace

std::vector<Vector3d> thinned(const std::vector<Vector3d>& points, double tolerance_mm) {
    if (points.size() < 3) {
        return points;
    }
    std::vector<char> keep(points.size(), 0);
    keep.front() = keep.back() = 1;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        double worst = tolerance_mm;
        std::size_t split = 0;
        for (std::size_t i = first + 1; i < last; ++i) {
            const double away = distance_to(points[i], points[first], points[last]);
            if (away > worst) {
                worst = away;
                split = i;
            }
        }
        if (split != 0) {
            keep[split] = 1;
            open.emplace_back(first, split);
            open.emplace_back(split, last);
        }
    }
    std::vector<Vector3d> out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (keep[i] != 0) {
            out.push_back(points[i]);
        }
    }
    return out;
}

void Writer::take(const Cutter& cutter, double rpm, path::MillOperation operation) {
    retract();
    operation_ = operation;
    if (cutter.tool.number != tool_) {
        if (rpm_ > 0) {
            add(path::MillSpindle{0});
        }
        add(path::MillTakeTool{cutter.tool.number});
        tool_ = cutter.tool.number;
        rpm_ = 0;
        at_.reset();
    }
    if (rpm != rpm_) {
        add(path::MillSpindle{rpm});
        rpm_ = rpm;
    }
}

void Writer::approach(const Vector3d& to, double clear_z, decomp::Speed plunge) {
    retract();
    const double safe = program_->safe_z;
    // The first move after a tool change goes up before anything else, wherever the machine is.
    if (!at_ || (*at_ - to).head<2>().norm() > kSamePoint) {
        at_ = Vector3d(to.x(), to.y(), safe);
        add(path::MillRapid{*at_});
    }
    const double down = std::min(safe, std::max(clear_z, to.z()));
    if (down < safe) {
        at_ = Vector3d(to.x(), to.y(), down);
        add(path::MillRapid{*at_});
    }
    cut(to, plunge);
}

void Writer::cut(const Vector3d& to, decomp::Speed feed) {
    if (at_ && (*at_ - to).norm() < kSamePoint) {
        return;
    }
    at_ = to;
    add(path::MillCut{to, feed});
}

void Writer::cut_along(const std::vector<Vector3d>& points, decomp::Speed feed) {
    for (const Vector3d& p : points) {
        cut(p, feed);
    }
}

void Writer::retract() {
    if (is_down()) {
        at_->z() = program_->safe_z;
        add(path::MillRapid{*at_});
    }
}

void Writer::finish() {
    retract();
    if (rpm_ > 0) {
        add(path::MillSpindle{0});
        rpm_ = 0;
    }
}

}  // namespace cam::mill
