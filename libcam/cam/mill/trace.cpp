// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/trace.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>

namespace cam::mill {

namespace {

using Eigen::Vector2d;

/// Edges of the lattice by number: those along a row are even, those along a column odd.
using Edge = std::uint64_t;

/// Directed pieces of the level line, and the chains that they make.
class Pieces {
  public:
    void add(Edge from, Edge to) {
        next_[from] = to;
        has_before_[to] = true;
    }

    /// The pieces in one cell, by which of its corners are low. Counter-clockwise around the cell:
    /// the line enters where low ends and leaves where it begins again, so that low lies to its
    /// left.
    template <class EdgeOf>
    void cross(const std::array<bool, 4>& below, const EdgeOf& edge_of) {
        for (std::size_t i = 0; i < 4; ++i) {
            if (below[i] && !below[(i + 1) % 4]) {
                // Low corners that meet only across a saddle are apart: back to the nearest.
                std::size_t j = i;
                while (below[j]) {
                    j = (j + 3) % 4;
                }
                add(edge_of(i), edge_of(j));
            }
        }
    }

    template <class Place>
    [[nodiscard]] std::vector<Chain> chains(const Place& place) {
        std::vector<Chain> out;
        for (const auto& [from, to] : next_) {
            if (!has_before_[from]) {
                out.push_back(follow(from, place));
            }
        }
        for (const auto& [from, to] : next_) {
            if (!done_[from]) {
                out.push_back(follow(from, place));
                out.back().closed = true;
            }
        }
        return out;
    }

  private:
    template <class Place>
    [[nodiscard]] Chain follow(Edge at, const Place& place) {
        Chain chain;
        while (!done_[at]) {
            done_[at] = true;
            chain.points.push_back(place(at));
            const auto found = next_.find(at);
            if (found == next_.end()) {
                break;
            }
            at = found->second;
        }
        return chain;
    }

    std::map<Edge, Edge> next_;
    std::map<Edge, bool> has_before_;
    std::map<Edge, bool> done_;
};

}  // namespace

std::vector<Chain> trace_level(
    const Lattice& lattice, double level, const std::function<bool(int, int)>& wanted,
    const std::function<Vector2d(const Vector2d&, const Vector2d&)>& crossing) {
    // Corners of a cell counter-clockwise from its lower left one; edge i leads from i to i + 1.
    constexpr std::array<std::array<int, 2>, 4> kCorner{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const auto low = [&](int column, int row) { return lattice.at(column, row) <= level; };
    const auto edge_of = [&](int column, int row, std::size_t side) -> Edge {
        const auto at = [&](int c, int r) { return 2 * static_cast<Edge>(lattice.index(c, r)); };
        switch (side) {
            case 0:
                return at(column, row);
            case 1:
                return at(column + 1, row) + 1;
            case 2:
                return at(column, row + 1);
            default:
                return at(column, row) + 1;
        }
    };
    Pieces pieces;
    for (int row = 0; row + 1 < lattice.rows; ++row) {
        for (int column = 0; column + 1 < lattice.columns; ++column) {
            std::array<bool, 4> below{};
            int count = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                below[i] = low(column + kCorner[i][0], row + kCorner[i][1]);
                count += below[i] ? 1 : 0;
            }
            if (count == 0 || count == 4 || (wanted && !wanted(column, row))) {
                continue;
            }
            pieces.cross(below, [&](std::size_t side) { return edge_of(column, row, side); });
        }
    }
    return pieces.chains([&](Edge edge) -> Vector2d {
        const auto node = static_cast<int>(edge / 2);
        const int column = node % lattice.columns;
        const int row = node / lattice.columns;
        const int to_column = column + (edge % 2 == 0 ? 1 : 0);
        const int to_row = row + (edge % 2 == 0 ? 0 : 1);
        const Vector2d a(column, row);
        const Vector2d b(to_column, to_row);
        const bool a_low = low(column, row);
        if (crossing) {
            return a_low ? crossing(a, b) : crossing(b, a);
        }
        const double za = lattice.at(column, row);
        const double zb = lattice.at(to_column, to_row);
        return a + (b - a) * std::clamp((level - za) / (zb - za), 0.0, 1.0);
    });
}

}  // namespace cam::mill
