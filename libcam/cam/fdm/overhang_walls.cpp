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

/// A stretch of a bead that lies over something, or over air, from end to end.
struct Stretch {
    std::vector<Vector2d> points;
    bool over_air = false;
    double length_mm = 0;

    void go_to(const Vector2d& p) {
        if (!points.empty()) {
            length_mm += (p - points.back()).norm();
        }
        if (points.empty() || points.back() != p) {
            points.push_back(p);
        }
    }
};

std::vector<Stretch> stretches_of(const Bead& bead, const EdgeGrid& below) {
    std::vector<Stretch> out(1);
    out.back().over_air = !below.contains(bead.points.front());
    out.back().go_to(bead.points.front());
    for (std::size_t i = 0; i + 1 < bead.points.size(); ++i) {
        for (const Meeting& m : below.meetings(bead.points[i], bead.points[i + 1])) {
            out.back().go_to(m.point.at_mm);
            Stretch next;
            next.over_air = !out.back().over_air;
            next.go_to(m.point.at_mm);
            out.push_back(std::move(next));
        }
        out.back().go_to(bead.points[i + 1]);
    }
    return out;
}

/// Short stretches over something between two over air join them, then short ones over air their
/// neighbours.
std::vector<Stretch> without_short_ones(std::vector<Stretch> stretches) {
    for (const bool over_air : {false, true}) {
        for (Stretch& s : stretches) {
            if (s.over_air == over_air && s.length_mm < kShortestMm) {
                s.over_air = !over_air;
            }
        }
        std::vector<Stretch> joined;
        for (Stretch& s : stretches) {
            if (joined.empty() || joined.back().over_air != s.over_air) {
                joined.push_back(std::move(s));
                continue;
            }
            for (const Vector2d& p : s.points) {
                joined.back().go_to(p);
            }
        }
        stretches = std::move(joined);
    }
    return stretches;
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
        std::vector<Stretch> stretches = without_short_ones(stretches_of(bead, grid));
        if (stretches.size() == 1 && !stretches.front().over_air) {
            out.push_back(std::move(bead));
            continue;
        }
        for (Stretch& s : stretches) {
            if (s.points.size() < 2) {
                continue;
            }
            Bead& piece = out.emplace_back(bead);
            piece.points = std::move(s.points);
            if (s.over_air) {
                piece.feature = Feature::OverhangWall;
                piece.speed = std::min(piece.speed, speed);
            }
        }
    }
    return out;
}

}  // namespace cam::fdm
