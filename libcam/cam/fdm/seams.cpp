// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/seams.h"

#include "cam/fdm/edge_grid.h"
#include "decomp/base/assert.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;

constexpr double kSharpTurn = 40.0 / 180.0 * std::numbers::pi;
constexpr double kCornerReachMm = 0.4;  // a corner's sides are looked at over this length
constexpr double kOnMatingMm = 1.0;     // a seam keeps that far from the ends of a mating stretch
constexpr double kSampleMm = 1.0;       // on mating stretches, which may have no vertices
// What a seam costs, in mm of distance from the seam below.
constexpr double kNearMatingEnd = 30;
constexpr double kNotConcave = 6;
constexpr double kNotSharp = 4;
constexpr double kFarthest = 8;      // beyond that a seam below is not followed
constexpr double kRearwards = 0.02;  // a mm further back: settles what nothing else does

double squared(const Vector2d& a, const Vector2d& b) { return (a - b).squaredNorm(); }

/// The first vertex at least kCornerReachMm away from vertex i, walking by `step` (1 or n - 1).
Vector2d neighbour(const Line& loop, std::size_t i, std::size_t step) {
    const std::size_t n = loop.size() - 1;
    std::size_t j = i;
    do {
        j = (j + step) % n;
    } while (j != i && squared(loop[j], loop[i]) < kCornerReachMm * kCornerReachMm);
    return loop[j];
}

enum class Corner { Smooth, Convex, Concave };

/// Loops have the material on their left, so a right turn is concave, of holes as well.
Corner corner_at(const Line& loop, std::size_t i) {
    const Vector2d in = loop[i] - neighbour(loop, i, loop.size() - 2);
    const Vector2d out = neighbour(loop, i, 1) - loop[i];
    const double turn = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    if (std::abs(turn) < kSharpTurn) {
        return Corner::Smooth;
    }
    return turn < 0 ? Corner::Concave : Corner::Convex;
}

double corner_cost(const Line& loop, std::size_t i) {
    switch (corner_at(loop, i)) {
        case Corner::Concave:
            return 0;
        case Corner::Convex:
            return kNotConcave;
        case Corner::Smooth:
            break;
    }
    return kNotConcave + kNotSharp;
}

/// A point of a loop: on its edge `edge`, at the edge's beginning or within it.
struct Spot {
    std::size_t edge = 0;
    Vector2d at = Vector2d::Zero();
    bool vertex = true;
};

std::vector<Spot> vertices_of(const Line& loop) {
    std::vector<Spot> out;
    for (std::size_t i = 0; i + 1 < loop.size(); ++i) {
        out.push_back({i, loop[i], true});
    }
    return out;
}

/// Points along the loop, at most kSampleMm apart.
std::vector<Spot> samples_of(const Line& loop) {
    std::vector<Spot> out;
    for (std::size_t i = 0; i + 1 < loop.size(); ++i) {
        const Vector2d along = loop[i + 1] - loop[i];
        const int parts = 1 + static_cast<int>(along.norm() / kSampleMm);
        for (int k = 0; k < parts; ++k) {
            out.push_back({i, loop[i] + along * (static_cast<double>(k) / parts), k == 0});
        }
    }
    return out;
}

/// The spots that lie on a mating face, with what their nearness to its ends costs.
std::vector<std::pair<Spot, double>> on_mating(const Line& loop, const EdgeGrid& mating,
                                               double reach_mm) {
    const std::vector<Spot> spots = samples_of(loop);
    std::vector<char> on(spots.size(), 0);
    for (std::size_t i = 0; i < spots.size(); ++i) {
        on[i] = static_cast<char>(mating.nearest(spots[i].at, reach_mm).has_value());
    }
    std::vector<std::pair<Spot, double>> out;
    const auto reaches = [&](std::size_t i, std::size_t step) {
        double way = 0;
        std::size_t j = i;
        do {
            const std::size_t next = (j + step) % spots.size();
            if (on[next] == 0) {
                return false;
            }
            way += (spots[next].at - spots[j].at).norm();
            j = next;
        } while (way < kOnMatingMm && j != i);
        return true;
    };
    for (std::size_t i = 0; i < spots.size(); ++i) {
        if (on[i] != 0) {
            const bool deep = reaches(i, 1) && reaches(i, spots.size() - 1);
            out.emplace_back(spots[i], deep ? 0 : kNearMatingEnd);
        }
    }
    return out;
}

void begin_at(Line& loop, const Spot& spot) {
    loop.pop_back();
    std::size_t index = spot.edge;
    if (!spot.vertex) {
        ++index;
        loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(index), spot.at);
    }
    std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(index), loop.end());
    loop.push_back(loop.front());
}

}  // namespace

SeamPlace seam_place(const std::string& name) {
    using Named = std::pair<const char*, SeamPlace>;
    for (const auto& [known, place] :
         {Named("hidden", SeamPlace::Hidden), Named("aligned", SeamPlace::Aligned),
          Named("rear", SeamPlace::Rear), Named("nearest", SeamPlace::Nearest)}) {
        if (name == known) {
            return place;
        }
    }
    DECOMP_ASSERT(false);
    return SeamPlace::Hidden;
}

double SeamPlanner::distance_to_last(const Vector2d& p) const {
    double least = last_.empty() ? 0 : kFarthest * kFarthest;
    for (const Vector2d& seam : last_) {
        least = std::min(least, squared(seam, p));
    }
    return std::sqrt(least);
}

void SeamPlanner::place_seams(std::vector<Line>& loops, const polygon::Paths& mating) {
    if (place_ == SeamPlace::Nearest) {
        return;
    }
    const EdgeGrid faces(place_ == SeamPlace::Hidden ? mating : polygon::Paths());
    std::vector<Vector2d> seams;
    for (Line& loop : loops) {
        Spot best;
        double least = 0;
        bool any = false;
        const auto offer = [&](const Spot& spot, double cost) {
            const double total =
                cost - kRearwards * spot.at.y() +
                (place_ == SeamPlace::Rear ? -spot.at.y() : distance_to_last(spot.at));
            if (!any || total < least) {
                any = true;
                least = total;
                best = spot;
            }
        };
        if (!faces.empty()) {
            for (const auto& [spot, cost] : on_mating(loop, faces, reach_mm_)) {
                offer(spot, cost);
            }
        }
        if (!any) {
            for (const Spot& spot : vertices_of(loop)) {
                const double corner = corner_cost(loop, spot.edge);
                offer(spot,
                      place_ == SeamPlace::Aligned && corner < kNotConcave ? kNotConcave : corner);
            }
        }
        begin_at(loop, best);
        seams.push_back(best.at);
    }
    last_ = std::move(seams);
}

}  // namespace cam::fdm
