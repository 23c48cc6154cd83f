// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/order.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

namespace decomp::labels {

namespace {

Eigen::Vector3d direction(AxisLabel label) {
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    out[axis_of(label)] = sign_of(label);
    return out;
}

/// Union-find over boundaries that also knows whether two bend alike.
class Bends {
  public:
    explicit Bends(std::size_t count) : parent_(count), differs_(count, false) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    /// The representative, and whether the boundary bends unlike it.
    [[nodiscard]] std::pair<std::uint32_t, bool> find(std::uint32_t b) const {
        bool differs = false;
        while (parent_[b] != b) {
            differs = differs != differs_[b];
            b = parent_[b];
        }
        return {b, differs};
    }

    /// False when this contradicts what is known.
    bool state(std::uint32_t a, std::uint32_t b, bool differ) {
        const auto [root_a, from_a] = find(a);
        const auto [root_b, from_b] = find(b);
        const bool between = (from_a != from_b) != differ;
        if (root_a == root_b) {
            return !between;
        }
        parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
        differs_[std::max(root_a, root_b)] = between;
        return true;
    }

  private:
    std::vector<std::uint32_t> parent_;
    std::vector<bool> differs_;  // from the parent
};

/// A boundary as one chart walks along it, and the one that it walks next.
struct Turn {
    std::uint32_t chart;
    std::uint32_t corner;
    std::uint32_t before;
    std::uint32_t after;
    bool left_if_alike;  // a turn to the left when both bend alike, to the right when not
};

std::vector<Turn> turns_of(const Layout& layout) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> leaving;  // chart, corner
    for (std::uint32_t b = 0; b < layout.boundaries.size(); ++b) {
        const Boundary& boundary = layout.boundaries[b];
        leaving[{boundary.left, boundary.vertices.front()}] = b;
        leaving[{boundary.right, boundary.vertices.back()}] = b;
    }
    std::vector<Turn> turns;
    const auto other = [&](std::uint32_t b, std::uint32_t chart) {
        const Boundary& boundary = layout.boundaries[b];
        return direction(
            layout.charts[boundary.left == chart ? boundary.right : boundary.left].label);
    };
    for (std::uint32_t b = 0; b < layout.boundaries.size(); ++b) {
        const Boundary& boundary = layout.boundaries[b];
        for (const auto& [chart, corner] : {std::pair(boundary.left, boundary.vertices.back()),
                                            std::pair(boundary.right, boundary.vertices.front())}) {
            const std::uint32_t next = leaving.at({chart, corner});
            const double side = other(b, chart)
                                    .cross(other(next, chart))
                                    .dot(direction(layout.charts[chart].label));
            turns.push_back({chart, corner, b, next, side > 0});
        }
    }
    return turns;
}

/// Vertices less edges plus facets of a chart with its border: 1 for a disc.
std::vector<int> euler_characteristics(const Facets& facets, const Layout& layout) {
    std::vector<int> out(layout.charts.size(), 0);
    std::vector<std::uint32_t> around;
    for (std::uint32_t f = 0; f < facets.count(); ++f) {
        const std::uint32_t chart = layout.chart_of[f];
        out[chart] += 1;
        for (const auto g : facets.neighbours[f]) {
            out[chart] -= layout.chart_of[g] != chart || f < g ? 1 : 0;
        }
    }
    for (std::uint32_t v = 0; v < facets.points.size(); ++v) {
        around.clear();
        for (const auto f : facets.around(v)) {
            around.push_back(layout.chart_of[f]);
        }
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        for (const auto chart : around) {
            out[chart] += 1;
        }
    }
    return out;
}

}  // namespace

bool impossible(const Facets& facets, const Layout& layout) {
    if (layout.violations() > 0) {
        return false;
    }
    const std::vector<Turn> turns = turns_of(layout);
    const std::vector<int> euler = euler_characteristics(facets, layout);
    std::vector<int> sides(layout.charts.size(), 0);
    for (const Turn& turn : turns) {
        ++sides[turn.chart];
    }
    Bends bends(layout.boundaries.size());
    std::map<std::uint32_t, std::vector<std::uint32_t>> mixed;  // boundaries at a corner
    for (const Turn& turn : turns) {
        const bool square = sides[turn.chart] == 4 && layout.charts[turn.chart].loops == 1 &&
                            euler[turn.chart] == 1;
        if ((turn.left_if_alike || square) &&
            !bends.state(turn.before, turn.after, !turn.left_if_alike)) {
            return true;
        }
        if (!turn.left_if_alike) {
            mixed[turn.corner].push_back(turn.before);
        }
    }
    // Turns to the left less turns to the right are 4 for a disc, 0 for a ring and so on.
    std::vector<int> left(layout.charts.size(), 0);
    std::vector<bool> known(layout.charts.size(), true);
    for (const Turn& turn : turns) {
        const auto before = bends.find(turn.before);
        const auto after = bends.find(turn.after);
        known[turn.chart] = known[turn.chart] && before.first == after.first;
        left[turn.chart] += turn.left_if_alike == (before.second == after.second) ? 1 : -1;
    }
    for (std::size_t chart = 0; chart < left.size(); ++chart) {
        if (known[chart] && left[chart] != 4 * euler[chart]) {
            return true;
        }
    }
    return std::any_of(mixed.begin(), mixed.end(), [&](const auto& corner) {
        const auto first = bends.find(corner.second.front());
        return corner.second.size() == 3 &&
               std::all_of(corner.second.begin(), corner.second.end(),
                           [&](std::uint32_t b) { return bends.find(b) == first; });
    });
}

}  // namespace decomp::labels
