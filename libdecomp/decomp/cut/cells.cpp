// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/cells.h"

#include "decomp/cut/exact.h"

namespace decomp::cut {

void Cells::expand_edge(Ref ref, std::vector<Ref>& leaves) const {
    const Edge& e = edge(ref);
    if (e.is_leaf()) {
        leaves.push_back(ref);
    } else if (is_reversed(ref)) {
        expand_edge(reversed(e.children[1]), leaves);
        expand_edge(reversed(e.children[0]), leaves);
    } else {
        expand_edge(e.children[0], leaves);
        expand_edge(e.children[1], leaves);
    }
}

void Cells::set_loop(std::int32_t index, const std::vector<Ref>& loop) {
    Face& f = faces[static_cast<std::size_t>(index)];
    f.begin = static_cast<std::uint32_t>(loops.size());
    f.count = static_cast<std::uint32_t>(loop.size());
    loops.insert(loops.end(), loop.begin(), loop.end());
}

std::int32_t Cells::add_face(Carrier carrier, std::int32_t inside, std::int32_t outside,
                             const std::vector<Ref>& loop) {
    const auto index = static_cast<std::int32_t>(faces.size());
    faces.push_back({carrier, inside, outside, 0, 0});
    set_loop(index, loop);
    return index;
}

Ref Cells::add_edge(std::int32_t from, std::int32_t to, Line line) {
    edges.push_back({from, to, line, {-1, -1}});
    return 2 * static_cast<Ref>(edges.size() - 1);
}

std::int32_t Cells::add_vertex(const Line& line, std::int32_t plane) {
    using Kind = VertexSource::Kind;
    switch (line.kind) {
        case Line::Kind::InputEdge:
            implicit.push_back({Kind::EdgePlane, line.a, line.b, plane});
            break;
        case Line::Kind::FacetPlane:
            implicit.push_back({Kind::FacetTwoPlanes, line.a, line.b, plane});
            break;
        case Line::Kind::TwoPlanes:
            implicit.push_back({Kind::ThreePlanes, line.a, line.b, plane});
            break;
    }
    const auto vertex = static_cast<std::int32_t>(points.size());
    points.push_back(rounded_point(*this, vertex));
    return vertex;
}

Line line_of(Carrier carrier, std::int32_t plane) {
    return {carrier.is_plane ? Line::Kind::TwoPlanes : Line::Kind::FacetPlane, carrier.index,
            plane};
}

}  // namespace decomp::cut
