// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/order.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;
using path::Bead;

constexpr std::size_t kMostForTwoOpt = 300;
constexpr int kTwoOptPasses = 4;

bool is_closed(const Bead& bead) {
    return bead.points.size() > 2 && bead.points.front() == bead.points.back();
}

double squared(const Vector2d& a, const Vector2d& b) { return (a - b).squaredNorm(); }

std::size_t nearest_vertex(const Bead& loop, const Vector2d& from) {
    std::size_t best = 0;
    for (std::size_t i = 1; i + 1 < loop.points.size(); ++i) {
        if (squared(loop.points[i], from) < squared(loop.points[best], from)) {
            best = i;
        }
    }
    return best;
}

/// Takes the beads nearest first; `arrive` prepares a bead (start vertex) and says where it would
/// be entered.
std::vector<Bead> nearest_first(std::vector<Bead> beads, Vector2d at) {
    std::vector<Bead> out;
    out.reserve(beads.size());
    std::vector<char> used(beads.size(), 0);
    for (std::size_t count = 0; count < beads.size(); ++count) {
        std::size_t best = beads.size();
        bool turned = false;
        double least = 0;
        for (std::size_t i = 0; i < beads.size(); ++i) {
            if (used[i] != 0) {
                continue;
            }
            const double front = squared(beads[i].points.front(), at);
            const double back = squared(beads[i].points.back(), at);
            if (best == beads.size() || std::min(front, back) < least) {
                best = i;
                least = std::min(front, back);
                turned = back < front;
            }
        }
        used[best] = 1;
        if (turned) {
            std::reverse(beads[best].points.begin(), beads[best].points.end());
        }
        at = beads[best].points.back();
        out.push_back(std::move(beads[best]));
    }
    return out;
}

/// Reverses the stretch [i, j] of the sequence, each bead in it as well.
void turn_stretch(std::vector<Bead>& beads, std::size_t i, std::size_t j) {
    std::reverse(beads.begin() + static_cast<std::ptrdiff_t>(i),
                 beads.begin() + static_cast<std::ptrdiff_t>(j) + 1);
    for (std::size_t k = i; k <= j; ++k) {
        std::reverse(beads[k].points.begin(), beads[k].points.end());
    }
}

bool two_opt_pass(std::vector<Bead>& beads, const Vector2d& start) {
    constexpr double kWorthMm = 1e-6;
    bool better = false;
    for (std::size_t i = 0; i < beads.size(); ++i) {
        for (std::size_t j = i; j < beads.size(); ++j) {
            const Vector2d& before = i == 0 ? start : beads[i - 1].points.back();
            double gain = (before - beads[i].points.front()).norm() -
                          (before - beads[j].points.back()).norm();
            if (j + 1 < beads.size()) {
                const Vector2d& after = beads[j + 1].points.front();
                gain += (beads[j].points.back() - after).norm() -
                        (beads[i].points.front() - after).norm();
            }
            if (gain > kWorthMm) {
                turn_stretch(beads, i, j);
                better = true;
            }
        }
    }
    return better;
}

/// Loops nearest first, each entered at its vertex nearest to where the nozzle is.
void append_loops(std::vector<Bead> loops, Vector2d& at, std::vector<Bead>& out) {
    std::vector<char> used(loops.size(), 0);
    for (std::size_t count = 0; count < loops.size(); ++count) {
        std::size_t best = loops.size();
        std::size_t vertex = 0;
        for (std::size_t i = 0; i < loops.size(); ++i) {
            if (used[i] != 0) {
                continue;
            }
            const std::size_t v = nearest_vertex(loops[i], at);
            if (best == loops.size() ||
                squared(loops[i].points[v], at) < squared(loops[best].points[vertex], at)) {
                best = i;
                vertex = v;
            }
        }
        used[best] = 1;
        start_at(loops[best], vertex);
        at = loops[best].points.back();
        out.push_back(std::move(loops[best]));
    }
}

void append(std::vector<Bead> beads, Vector2d& at, std::vector<Bead>& out) {
    if (!beads.empty()) {
        at = beads.back().points.back();
        std::move(beads.begin(), beads.end(), std::back_inserter(out));
    }
}

double squared_distance(const IslandBeads& island, const Vector2d& at) {
    double least = -1;
    for (const auto* beads :
         {&island.inner_walls, &island.outer_walls, &island.gaps, &island.fill, &island.top}) {
        for (const Bead& bead : *beads) {
            for (const Vector2d& p : bead.points) {
                const double d = squared(p, at);
                least = least < 0 ? d : std::min(least, d);
            }
        }
    }
    return least;
}

}  // namespace

void start_at(Bead& loop, std::size_t index) {
    if (index == 0 || !is_closed(loop)) {
        return;
    }
    loop.points.pop_back();
    std::rotate(loop.points.begin(), loop.points.begin() + static_cast<std::ptrdiff_t>(index),
                loop.points.end());
    loop.points.push_back(loop.points.front());
}

std::vector<Bead> ordered_by_travel(std::vector<Bead> beads, const Vector2d& start_mm) {
    beads = nearest_first(std::move(beads), start_mm);
    if (beads.size() <= kMostForTwoOpt) {
        for (int pass = 0; pass < kTwoOptPasses && two_opt_pass(beads, start_mm); ++pass) {
        }
    }
    return beads;
}

std::vector<Bead> ordered(std::vector<IslandBeads> islands, const Vector2d& start_mm, Seams seams) {
    std::vector<Bead> out;
    Vector2d at = start_mm;
    std::vector<char> used(islands.size(), 0);
    for (std::size_t count = 0; count < islands.size(); ++count) {
        std::size_t best = islands.size();
        double least = 0;
        for (std::size_t i = 0; i < islands.size(); ++i) {
            const double d =
                used[i] != 0 || islands.size() == 1 ? 0 : squared_distance(islands[i], at);
            if (used[i] == 0 && (best == islands.size() || d < least)) {
                best = i;
                least = d;
            }
        }
        used[best] = 1;
        IslandBeads& island = islands[best];
        append_loops(std::move(island.inner_walls), at, out);
        if (seams == Seams::Free) {
            append_loops(std::move(island.outer_walls), at, out);
        } else {
            append(nearest_first(std::move(island.outer_walls), at), at, out);
        }
        append(ordered_by_travel(std::move(island.gaps), at), at, out);
        append(ordered_by_travel(std::move(island.fill), at), at, out);
        append(std::move(island.top), at, out);
    }
    return out;
}

}  // namespace cam::fdm
