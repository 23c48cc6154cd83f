// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/constraints_detail.h"
#include "decomp/tets/boundary.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace decomp::map {

namespace {

constexpr int kSurfacePasses = 20;
constexpr int kInnerPasses = 40;

/// The corners that the six edges of a tet join.
constexpr std::array<std::array<std::size_t, 2>, 6> kTetEdges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

Edge edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

struct Incidence {
    Edge edge{};
    std::uint32_t element = 0;

    // clang-tidy 14 takes the 0 inside a defaulted comparison for a null pointer.
    // NOLINTNEXTLINE(modernize-use-nullptr)
    auto operator<=>(const Incidence&) const = default;
};

/// Calls body(edge, first incidence, last incidence) for each edge, by rising edge.
template <class Body>
void for_each_edge(std::vector<Incidence>& incidences, const Body& body) {
    std::sort(incidences.begin(), incidences.end());
    for (auto begin = incidences.begin(); begin != incidences.end();) {
        auto end = begin;
        while (end != incidences.end() && end->edge == begin->edge) {
            ++end;
        }
        body(begin->edge, begin, end);
        begin = end;
    }
}

std::vector<Incidence> facet_edges(const LabelledTets& tets) {
    std::vector<Incidence> out;
    out.reserve(3 * tets.facets.size());
    for (std::uint32_t f = 0; f < tets.facets.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            out.push_back({edge_of(tets.facets[f].at(k), tets.facets[f].at((k + 1) % 3)), f});
        }
    }
    return out;
}

std::vector<Edge> sorted_surface_edges(const LabelledTets& tets) {
    std::vector<Edge> out;
    for (const Incidence& incidence : facet_edges(tets)) {
        out.push_back(incidence.edge);
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

std::vector<Incidence> tet_edges(const std::vector<tets::Tet>& tets) {
    std::vector<Incidence> out;
    out.reserve(6 * tets.size());
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
        for (const auto& [a, b] : kTetEdges) {
            out.push_back({edge_of(tets[t].at(a), tets[t].at(b)), t});
        }
    }
    return out;
}

/// The element with corner `from` replaced by `to`.
template <class Element>
Element replaced(Element element, std::uint32_t from, std::uint32_t to) {
    std::replace(element.begin(), element.end(), from, to);
    return element;
}

std::uint32_t add_middle(LabelledTets& tets, const Edge& edge) {
    const auto middle = static_cast<std::uint32_t>(tets.mesh.points.size());
    const Eigen::Vector3d point = (tets.mesh.points[edge[0]] + tets.mesh.points[edge[1]]) / 2;
    tets.mesh.points.push_back(point);
    tets.parents.push_back(edge);
    return middle;
}

template <class Element>
void split_element(std::vector<Element>& elements, std::size_t index, const Edge& edge,
                   std::uint32_t middle) {
    elements.push_back(replaced(elements[index], edge[1], middle));
    elements[index] = replaced(elements[index], edge[0], middle);
}

/// One pass over the surface edges inside a chart whose ends share two coordinates.
std::size_t split_surface_pass(LabelledTets& tets) {
    const Unknowns unknowns = unknowns_of(tets);
    std::vector<Incidence> incidences = facet_edges(tets);
    std::vector<Edge> chosen;
    std::vector<char> used(tets.facets.size(), 0);
    for_each_edge(incidences, [&](const Edge& edge, auto begin, auto end) {
        if (end - begin != 2) {
            return;
        }
        const std::uint32_t f = begin->element;
        const std::uint32_t g = (begin + 1)->element;
        int shared = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            shared += unknowns.shared(edge[0], edge[1], axis) ? 1 : 0;
        }
        if (tets.labels[f] == tets.labels[g] && shared >= 2 && used[f] == 0 && used[g] == 0) {
            used[f] = used[g] = 1;
            chosen.push_back(edge);
        }
    });
    return split_edges(tets, std::move(chosen));
}

}  // namespace

Unknowns unknowns_of(const LabelledTets& tets) {
    const std::size_t points = tets.mesh.points.size();
    Unknowns out;
    out.of_point.resize(points);
    std::vector<std::uint32_t> parent(3 * points);
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        return i;
    };
    const auto unite = [&](std::uint32_t a, std::uint32_t b) {
        const std::uint32_t i = root(a);
        const std::uint32_t j = root(b);
        parent[std::max(i, j)] = std::min(i, j);
    };
    for (std::size_t f = 0; f < tets.facets.size(); ++f) {
        const auto axis = static_cast<std::uint32_t>(labels::axis_of(tets.labels[f]));
        const mesh::Triangle& t = tets.facets[f];
        unite(3 * t[0] + axis, 3 * t[1] + axis);
        unite(3 * t[1] + axis, 3 * t[2] + axis);
    }
    std::vector<std::uint32_t> number(3 * points, std::numeric_limits<std::uint32_t>::max());
    for (std::uint32_t i = 0; i < 3 * points; ++i) {
        std::uint32_t& mine = number[root(i)];
        if (mine == std::numeric_limits<std::uint32_t>::max()) {
            mine = static_cast<std::uint32_t>(out.count++);
        }
        out.of_point[i / 3].at(i % 3) = mine;
    }
    return out;
}

std::vector<TetUnknowns> rows_of(const Unknowns& unknowns, const std::vector<tets::Tet>& tets) {
    std::vector<TetUnknowns> rows(tets.size());
    for (std::size_t t = 0; t < tets.size(); ++t) {
        for (std::size_t k = 0; k < 4; ++k) {
            for (std::size_t d = 0; d < 3; ++d) {
                rows[t].at(3 * k + d) = unknowns.of_point[tets[t].at(k)].at(d);
            }
        }
    }
    return rows;
}

std::size_t split_edges(LabelledTets& tets, std::vector<Edge> edges) {
    std::sort(edges.begin(), edges.end());
    const auto wanted = [&](const Edge& edge) {
        return std::binary_search(edges.begin(), edges.end(), edge);
    };
    std::vector<Incidence> of_tets = tet_edges(tets.mesh.tets);
    std::erase_if(of_tets, [&](const Incidence& i) { return !wanted(i.edge); });
    std::vector<Incidence> of_facets = facet_edges(tets);
    std::erase_if(of_facets, [&](const Incidence& i) { return !wanted(i.edge); });
    std::sort(of_facets.begin(), of_facets.end());
    std::vector<char> used(tets.mesh.tets.size(), 0);
    std::size_t splits = 0;
    for_each_edge(of_tets, [&](const Edge& edge, auto begin, auto end) {
        if (std::any_of(begin, end, [&](const Incidence& i) { return used[i.element] != 0; })) {
            return;
        }
        const std::uint32_t middle = add_middle(tets, edge);
        ++splits;
        for (auto i = begin; i != end; ++i) {
            used[i->element] = 1;
            split_element(tets.mesh.tets, i->element, edge, middle);
        }
        // Two facets of one tet are never split both: the tet is used by then.
        for (auto i = std::lower_bound(of_facets.begin(), of_facets.end(), Incidence{edge, 0});
             i != of_facets.end() && i->edge == edge; ++i) {
            split_element(tets.facets, i->element, edge, middle);
            tets.labels.push_back(tets.labels[i->element]);
        }
    });
    return splits;
}

std::size_t split_all(LabelledTets& tets, const std::vector<Edge>& edges) {
    std::size_t splits = 0;
    for (std::size_t now = 1; now > 0;) {
        now = split_edges(tets, edges);
        splits += now;
    }
    return splits;
}

namespace {

/// The edges a - b of tets whose faces opposite to a and to b both lie on the boundary.
void append_caught_edges(const LabelledTets& tets, std::vector<Edge>& out) {
    std::vector<mesh::Triangle> facets;
    facets.reserve(tets.facets.size());
    for (mesh::Triangle t : tets.facets) {
        std::sort(t.begin(), t.end());
        facets.push_back(t);
    }
    std::sort(facets.begin(), facets.end());
    for (const tets::Tet& tet : tets.mesh.tets) {
        std::array<bool, 4> outer{};
        for (std::size_t k = 0; k < 4; ++k) {
            mesh::Triangle face = tets::face_of(tet, k);
            std::sort(face.begin(), face.end());
            outer.at(k) = std::binary_search(facets.begin(), facets.end(), face);
        }
        for (const auto& [a, b] : kTetEdges) {
            if (outer.at(a) && outer.at(b)) {
                out.push_back(edge_of(tet.at(a), tet.at(b)));
            }
        }
    }
}

/// The edges of tets whose ends share a coordinate.
std::vector<Edge> sharing_edges(const LabelledTets& tets) {
    const Unknowns unknowns = unknowns_of(tets);
    std::vector<Edge> out;
    for (const tets::Tet& tet : tets.mesh.tets) {
        for (const auto& [a, b] : kTetEdges) {
            const Edge edge = edge_of(tet.at(a), tet.at(b));
            if (unknowns.shared(edge[0], edge[1], 0) || unknowns.shared(edge[0], edge[1], 1) ||
                unknowns.shared(edge[0], edge[1], 2)) {
                out.push_back(edge);
            }
        }
    }
    return out;
}

/// The three edges of the face opposite to corner k.
void append_opposite_edges(const tets::Tet& tet, std::size_t k, std::vector<Edge>& out) {
    for (const auto& [a, b] : kTetEdges) {
        if (a != k && b != k) {
            out.push_back(edge_of(tet.at(a), tet.at(b)));
        }
    }
}

}  // namespace

std::size_t split_bound_edges(LabelledTets& tets) {
    std::size_t splits = 0;
    for (int pass = 0; pass < kSurfacePasses; ++pass) {
        const std::size_t now = split_surface_pass(tets);
        splits += now;
        if (now == 0) {
            break;
        }
    }
    for (int pass = 0; pass < kInnerPasses; ++pass) {
        const std::vector<Edge> surface = sorted_surface_edges(tets);
        std::vector<Edge> bound = sharing_edges(tets);
        append_caught_edges(tets, bound);
        std::erase_if(bound, [&](const Edge& edge) {
            return std::binary_search(surface.begin(), surface.end(), edge);
        });
        const std::size_t now = split_edges(tets, std::move(bound));
        splits += now;
        if (now == 0) {
            break;
        }
    }
    return splits;
}

std::size_t split_about_corners(LabelledTets& tets) {
    std::vector<unsigned> sides(tets.mesh.points.size(), 0);
    for (std::size_t f = 0; f < tets.facets.size(); ++f) {
        for (const std::uint32_t corner : tets.facets[f]) {
            sides[corner] |= 1U << static_cast<unsigned>(tets.labels[f]);
        }
    }
    std::vector<Edge> opposite;
    for (const tets::Tet& tet : tets.mesh.tets) {
        for (std::size_t k = 0; k < 4; ++k) {
            if (std::popcount(sides[tet.at(k)]) >= 3) {
                append_opposite_edges(tet, k, opposite);
            }
        }
    }
    return split_all(tets, opposite);
}

}  // namespace decomp::map
