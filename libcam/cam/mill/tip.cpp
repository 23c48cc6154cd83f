// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/tip.h"

#include "cam/mill/finish.h"
#include "cam/tool/outline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cam::mill {

using Eigen::Vector2d;
using Eigen::Vector3d;

Tip::Tip(const cutter::Surface& surface, const tool::Tool& tool, check::HeightMap body,
         double floor)
    : drop_(surface, tool::outline_of(tool)), body_(std::move(body)), floor_(floor) {}

double Tip::lowest(const Vector2d& at, double floor) const {
    return drop_.lowest_tip(at, std::max({floor, floor_, body(at)}));
}

double Tip::body(const Vector2d& at) const {
    return std::max<double>(highest_near(body_, at), floor_);
}

bool Tip::clears(const Vector2d& at, double z) const {
    return z >= body(at) - kPlaceMm && drop_.clears(at, z);
}

void Tip::follow(const Vector3d& a, const Vector3d& b, std::vector<Vector3d>& out) const {
    refine(a, b, out);
    out.push_back(b);
}

/// A chord may be right in its middle and cut beside it.
bool Tip::cuts_beside_middle(const Vector3d& a, const Vector3d& b) const {
    for (const double share : {0.25, 0.75}) {
        const Vector3d p = a + share * (b - a);
        if (!drop_.clears(p.head<2>(), p.z() + kFinishToleranceMm)) {
            return true;
        }
    }
    return false;
}

void Tip::refine(const Vector3d& a, const Vector3d& b, std::vector<Vector3d>& out) const {
    const Vector2d middle = (a + b).head<2>() / 2;
    const double length = (b - a).head<2>().norm();
    const double chord = (a.z() + b.z()) / 2;
    const double z = lowest(middle, chord - kDip);
    const bool gouges = z > chord + kFinishToleranceMm || cuts_beside_middle(a, b);
    // A steep chord goes up a wall: right beside it, or it leaves the foot.
    const bool steep = std::abs(a.z() - b.z()) > length;
    const bool dips = z <= chord - kDip && length > (steep ? kShortest : kCoarsest);
    if (!gouges && !dips) {
        return;
    }
    if (length < kShortest) {
        // A wall: up or down on its free side.
        const Vector3d& low = a.z() < b.z() ? a : b;
        out.emplace_back(low.x(), low.y(), std::max({z, a.z(), b.z()}));
        return;
    }
    const Vector3d split(middle.x(), middle.y(), z > chord - kDip ? z : lowest(middle));
    refine(a, split, out);
    out.push_back(split);
    refine(split, b, out);
}

}  // namespace cam::mill
