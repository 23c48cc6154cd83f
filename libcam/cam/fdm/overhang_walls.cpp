// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/overhang_walls.h"

#include "cam/fdm/edge_grid.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;
using path::Bead;
using path::Feature;

constexpr double kShortestMm = 1.0;
constexpr double kSampleMm = 0.5;  // between two looks along a wall

/// Quarters of a wall's width over air, rounded down: 0 .. 3.
using Level = int;
constexpr Level kHalf = 2;
constexpr Level kMost = 3;

/// A stretch of a bead of one level from end to end.
struct Stretch {
    std::vector<Vector2d> points;
    Level level = 0;
    double length_mm = 0;

    void go_to(const Vector2d& p) {
        if (!points.empty()) {
            length_mm += (p - points.back()).norm();
        }
        if (points.empty() || points.back() != p) {
            points.push_back(p);
        }
    }

    void go_along(const std::vector<Vector2d>& others) {
        for (const Vector2d& p : others) {
            go_to(p);
        }
    }
};

/// Walks along one bead.
class Walk {
  public:
    Walk(const Bead& bead, const EdgeGrid& below) : bead_(bead), below_(below) {}

    std::vector<Stretch> stretches() {
        over_air_ = !below_.contains(bead_.points.front());
        at_ = bead_.points.front();
        for (std::size_t i = 0; i + 1 < bead_.points.size(); ++i) {
            for (const Meeting& m : below_.meetings(bead_.points[i], bead_.points[i + 1])) {
                walk_to(m.point.at_mm);
                over_air_ = !over_air_;
            }
            walk_to(bead_.points[i + 1]);
        }
        return std::move(out_);
    }

  private:
    /// Straight, on one side of what lies below.
    void walk_to(const Vector2d& to) {
        const Vector2d from = at_;
        const int steps = 1 + static_cast<int>((to - from).norm() / kSampleMm);
        for (int k = 0; k < steps; ++k) {
            const Level level = level_at(from + (to - from) * ((k + 0.5) / steps));
            const Vector2d start = from + (to - from) * (static_cast<double>(k) / steps);
            if (out_.empty() || out_.back().level != level) {
                if (!out_.empty()) {
                    out_.back().go_to(start);
                }
                out_.emplace_back().level = level;
                out_.back().go_to(start);
            }
        }
        out_.back().go_to(to);
        at_ = to;
    }

    [[nodiscard]] Level level_at(const Vector2d& p) const {
        const bool near = below_.nearest(p, bead_.width_mm / 4).has_value();
        return over_air_ ? (near ? kHalf : kMost) : (near ? 1 : 0);
    }

    const Bead& bead_;
    const EdgeGrid& below_;
    Vector2d at_ = Vector2d::Zero();
    bool over_air_ = false;
    std::vector<Stretch> out_;
};

std::vector<Stretch> joined(std::vector<Stretch> stretches) {
    std::vector<Stretch> out;
    for (Stretch& s : stretches) {
        if (out.empty() || out.back().level != s.level) {
            out.push_back(std::move(s));
        } else {
            out.back().go_along(s.points);
        }
    }
    return out;
}

/// Short dips between worse stretches are taken for as bad as the better of these, then short
/// stretches go with the neighbour that is most like them.
std::vector<Stretch> without_short_ones(std::vector<Stretch> stretches) {
    for (const bool dips : {true, false}) {
        for (std::size_t i = 0; i < stretches.size() && stretches.size() > 1; ++i) {
            Stretch& s = stretches[i];
            if (s.length_mm >= kShortestMm) {
                continue;
            }
            const Level before = stretches[i > 0 ? i - 1 : i + 1].level;
            const Level after = stretches[i + 1 < stretches.size() ? i + 1 : i - 1].level;
            const auto [low, high] = std::minmax(before, after);
            if (dips) {
                s.level = std::max(s.level, low);
            } else {
                s.level = high - s.level <= s.level - low || s.level >= high ? high : low;
            }
        }
        stretches = joined(std::move(stretches));
    }
    return stretches;
}

decomp::Speed slowed(decomp::Speed own, decomp::Speed least, Level level) {
    const double v = own.mm_per_s();
    const double low = std::min(v, least.mm_per_s());
    return decomp::Speed::mm_per_s(v - (v - low) * level / kMost);
}

}  // namespace

std::vector<Bead> with_overhangs(std::vector<Bead> beads, const polygon::Paths& below,
                                 decomp::Speed speed) {
    const EdgeGrid grid(below);
    std::vector<Bead> out;
    out.reserve(beads.size());
    for (Bead& bead : beads) {
        if (bead.feature != Feature::OuterWall && bead.feature != Feature::InnerWall) {
            out.push_back(std::move(bead));
            continue;
        }
        std::vector<Stretch> stretches = without_short_ones(Walk(bead, grid).stretches());
        if (stretches.size() == 1 && stretches.front().level == 0) {
            out.push_back(std::move(bead));
            continue;
        }
        for (Stretch& s : stretches) {
            if (s.points.size() < 2) {
                continue;
            }
            Bead& piece = out.emplace_back(bead);
            piece.points = std::move(s.points);
            piece.speed = slowed(piece.speed, speed, s.level);
            if (s.level >= kHalf) {
                piece.feature = Feature::OverhangWall;
            }
        }
    }
    return out;
}

}  // namespace cam::fdm
