// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/layout.h"

#include <algorithm>
#include <array>
#include <limits>

namespace decomp::labels {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr double kProminence = 0.015;  // of the diagonal
constexpr int kOppositeWeight = 2;

/// One side of an edge between two charts: edge k of a facet, the facet's chart on its left.
struct Rim {
    std::uint32_t facet;
    std::uint32_t k;
};

/// A side of a chart's boundary loop: the edges towards one neighbour, between two corners.
struct Side {
    std::uint32_t neighbour;
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t> facets;
};

class Survey {
  public:
    Survey(const Facets& facets, const Labeling& labels) : facets_(facets), labels_(labels) {}

    Layout take() {
        find_charts();
        find_rims();
        find_corners();
        walk_loops();
        for (Chart& chart : out_.charts) {
            std::sort(chart.neighbours.begin(), chart.neighbours.end());
            chart.neighbours.erase(std::unique(chart.neighbours.begin(), chart.neighbours.end()),
                                   chart.neighbours.end());
        }
        find_turning_points();
        return std::move(out_);
    }

  private:
    void find_charts() {
        out_.chart_of.assign(facets_.count(), kNone);
        std::vector<std::uint32_t> stack;
        for (std::uint32_t seed = 0; seed < facets_.count(); ++seed) {
            if (out_.chart_of[seed] != kNone) {
                continue;
            }
            stack.assign(1, seed);
            out_.charts.push_back(flood(stack));
        }
    }

    /// The next chart: the facets of one label that hang together with the one on the stack.
    Chart flood(std::vector<std::uint32_t>& stack) {
        const auto id = static_cast<std::uint32_t>(out_.charts.size());
        Chart chart;
        chart.label = labels_[stack.back()];
        out_.chart_of[stack.back()] = id;
        while (!stack.empty()) {
            const std::uint32_t f = stack.back();
            stack.pop_back();
            chart.area += facets_.areas[f];
            for (const auto g : facets_.neighbours[f]) {
                if (out_.chart_of[g] == kNone && labels_[g] == chart.label) {
                    out_.chart_of[g] = id;
                    stack.push_back(g);
                }
            }
        }
        return chart;
    }

    [[nodiscard]] bool is_rim(std::uint32_t f, std::uint32_t k) const {
        return out_.chart_of[f] != out_.chart_of[facets_.neighbours[f].at(k)];
    }

    void find_rims() {
        rim_degree_.assign(facets_.points.size(), 0);
        for (std::uint32_t f = 0; f < facets_.count(); ++f) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                if (!is_rim(f, k)) {
                    continue;
                }
                const std::uint32_t g = facets_.neighbours[f].at(k);
                rims_.push_back({f, k});
                ++rim_degree_[facets_.corners[f].at(k)];  // each edge counts once at either end
                const std::uint32_t a = out_.chart_of[f];
                const std::uint32_t b = out_.chart_of[g];
                out_.charts[a].neighbours.push_back(b);
            }
        }
    }

    void find_corners() {
        for (const Rim& rim : rims_) {
            const std::uint32_t v = facets_.corners[rim.facet].at(rim.k);
            if (rim_degree_[v] >= 3) {
                out_.corners.push_back(v);
            }
        }
        std::sort(out_.corners.begin(), out_.corners.end());
        out_.corners.erase(std::unique(out_.corners.begin(), out_.corners.end()),
                           out_.corners.end());
        for (const auto v : out_.corners) {
            if (rim_degree_[v] > 3) {
                out_.bad_corners.push_back(v);
            }
        }
    }

    /// The rim that follows along the same chart: about the end vertex, without leaving the chart.
    [[nodiscard]] Rim next(Rim rim) const {
        const std::uint32_t end = facets_.corners[rim.facet].at((rim.k + 1) % 3);
        std::uint32_t f = rim.facet;
        std::uint32_t k = (rim.k + 1) % 3;
        while (!is_rim(f, k)) {
            const std::uint32_t g = facets_.neighbours[f].at(k);
            k = 0;
            while (facets_.corners[g].at(k) != end) {
                ++k;
            }
            f = g;
        }
        return {f, k};
    }

    [[nodiscard]] std::uint32_t start(Rim rim) const {
        return facets_.corners[rim.facet].at(rim.k);
    }

    [[nodiscard]] std::uint32_t across(Rim rim) const {
        return out_.chart_of[facets_.neighbours[rim.facet].at(rim.k)];
    }

    void walk_loops() {
        std::vector<bool> walked(3 * facets_.count(), false);
        std::vector<Rim> loop;
        for (const Rim& first : rims_) {
            if (walked[3 * first.facet + first.k]) {
                continue;
            }
            loop.clear();
            for (Rim rim = first; !walked[3 * rim.facet + rim.k]; rim = next(rim)) {
                walked[3 * rim.facet + rim.k] = true;
                loop.push_back(rim);
            }
            take_loop(loop);
        }
    }

    void take_loop(std::vector<Rim>& loop) {
        const std::uint32_t id = out_.chart_of[loop.front().facet];
        const auto corner = std::find_if(
            loop.begin(), loop.end(), [&](const Rim& rim) { return rim_degree_[start(rim)] >= 3; });
        const bool closed = corner == loop.end();
        if (!closed) {
            std::rotate(loop.begin(), corner, loop.end());
        }
        std::vector<Side> sides;
        for (const Rim& rim : loop) {
            if (sides.empty() || rim_degree_[start(rim)] >= 3) {
                if (!sides.empty()) {
                    sides.back().vertices.push_back(start(rim));
                }
                sides.push_back({across(rim), {}, {}});
            }
            sides.back().vertices.push_back(start(rim));
            sides.back().facets.push_back(rim.facet);
        }
        sides.back().vertices.push_back(start(loop.front()));
        Chart& chart = out_.charts[id];
        ++chart.loops;
        chart.deficiency += deficiency(chart.label, sides);
        for (Side& side : sides) {
            if (id < side.neighbour) {
                out_.boundaries.push_back(
                    {id, side.neighbour, std::move(side.vertices), std::move(side.facets), closed});
            }
        }
    }

    /// A rectilinear loop has lines at two coordinates at least along either axis of its plane, and
    /// each comes from a neighbour of its own.
    [[nodiscard]] int deficiency(AxisLabel label, const std::vector<Side>& sides) const {
        std::array<std::vector<std::uint32_t>, 3> along;
        for (const Side& side : sides) {
            auto& seen =
                along.at(static_cast<std::size_t>(axis_of(out_.charts[side.neighbour].label)));
            if (std::find(seen.begin(), seen.end(), side.neighbour) == seen.end()) {
                seen.push_back(side.neighbour);
            }
        }
        int lacking = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (static_cast<int>(axis) != axis_of(label)) {
                lacking += std::max(0, 2 - static_cast<int>(along.at(axis).size()));
            }
        }
        return lacking;
    }

    void find_turning_points() {
        for (std::uint32_t b = 0; b < out_.boundaries.size(); ++b) {
            const Boundary& boundary = out_.boundaries[b];
            const int axis =
                run_axis(out_.charts[boundary.left].label, out_.charts[boundary.right].label);
            if (axis >= 0) {
                find_turning_points(b, axis);
            } else {
                out_.opposite.push_back(b);
            }
        }
    }

    /// Extrema of the coordinate that are left by more than the prominence on both sides.
    void find_turning_points(std::uint32_t boundary, int axis) {
        const double prominence = kProminence * facets_.diagonal;
        const auto& vertices = out_.boundaries[boundary].vertices;
        const auto height = [&](std::uint32_t v) { return facets_.points[v][axis]; };
        double low = height(vertices.front());
        double high = low;
        int direction = 0;
        std::uint32_t extreme = vertices.front();
        for (const auto v : vertices) {
            const double h = height(v);
            if (direction == 0) {
                low = std::min(low, h);
                high = std::max(high, h);
                direction = h - low > prominence ? 1 : (high - h > prominence ? -1 : 0);
                extreme = direction == 0 ? extreme : v;
            } else if ((h - height(extreme)) * direction > 0) {
                extreme = v;
            } else if ((height(extreme) - h) * direction > prominence) {
                out_.turning_points.push_back({extreme, boundary, axis, direction});
                direction = -direction;
                extreme = v;
            }
        }
    }

    const Facets& facets_;
    const Labeling& labels_;
    Layout out_;
    std::vector<Rim> rims_;
    std::vector<int> rim_degree_;  // boundary edges at each vertex
};

}  // namespace

int Layout::violations() const {
    int sum =
        kOppositeWeight * static_cast<int>(opposite.size()) + static_cast<int>(bad_corners.size());
    for (const Chart& chart : charts) {
        // A closed component with one label has no loop at all, hence lacks all four neighbours.
        sum += chart.loops == 0 ? 4 : chart.deficiency;
    }
    return sum;
}

Layout layout_of(const Facets& facets, const Labeling& labels) {
    return Survey(facets, labels).take();
}

}  // namespace decomp::labels
