// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/pinch.h"

#include <algorithm>
#include <utility>

namespace decomp::cut {

std::vector<std::int32_t> pinched_edges(const Cells& cells) {
    std::vector<std::uint8_t> faces_at(cells.edges.size(), 0);
    std::vector<Ref> leaves;
    for (const Face& face : cells.faces) {
        cells.expand(face, leaves);
        for (const Ref leaf : leaves) {
            std::uint8_t& count = faces_at[static_cast<std::size_t>(edge_of(leaf))];
            count = static_cast<std::uint8_t>(std::min(count + 1, 3));
        }
    }
    std::vector<std::pair<std::int32_t, std::int32_t>> uses;  // edge, region
    for (const Face& face : cells.faces) {
        cells.expand(face, leaves);
        for (const Ref leaf : leaves) {
            if (faces_at[static_cast<std::size_t>(edge_of(leaf))] <= 2) {
                continue;
            }
            uses.emplace_back(edge_of(leaf), face.inside);
            if (face.outside >= 0) {
                uses.emplace_back(edge_of(leaf), face.outside);
            }
        }
    }
    std::sort(uses.begin(), uses.end());
    std::vector<std::int32_t> out;
    for (std::size_t i = 2; i < uses.size(); ++i) {
        if (uses[i] == uses[i - 2] && (out.empty() || out.back() != uses[i].first)) {
            out.push_back(uses[i].first);
        }
    }
    return out;
}

void bisect(Cells& cells, const std::vector<std::int32_t>& edges) {
    for (const std::int32_t index : edges) {
        const Edge edge = cells.edges[static_cast<std::size_t>(index)];
        const Eigen::Vector3d& from = cells.point(edge.from);
        const Eigen::Vector3d& to = cells.point(edge.to);
        Eigen::Index axis = 0;
        (to - from).cwiseAbs().maxCoeff(&axis);
        const double low = std::min(from[axis], to[axis]);
        const double high = std::max(from[axis], to[axis]);
        const double middle = low + (high - low) / 2;
        if (!(low < middle && middle < high)) {
            continue;
        }
        cells.planes.push_back({Eigen::Vector3d::Unit(axis), middle});
        const std::int32_t vertex =
            cells.add_vertex(edge.line, static_cast<std::int32_t>(cells.planes.size() - 1));
        const Ref first = cells.add_edge(edge.from, vertex, edge.line);
        const Ref second = cells.add_edge(vertex, edge.to, edge.line);
        cells.edges[static_cast<std::size_t>(index)].children = {first, second};
    }
}

}  // namespace decomp::cut
