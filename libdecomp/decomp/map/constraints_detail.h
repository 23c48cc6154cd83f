// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/labeling.h"
#include "decomp/map/energy_detail.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/tets/tet_mesh.h"

#include <vector>

namespace decomp::map {

/// Two points, the smaller number first.
using Edge = std::array<std::uint32_t, 2>;

/// Tets with their labelled boundary, as the map works on them.
struct LabelledTets {
    tets::TetMesh mesh;
    std::vector<mesh::Triangle> facets;  ///< of the boundary
    labels::Labeling labels;             ///< one for each facet
    std::vector<Edge> parents;  ///< of the points that splits have added, in order: each lies in
                                ///< the middle of its two parents
};

/// Which coordinates of the polycube are one and the same: the corners of a facet labelled +-d
/// share coordinate d, and so a whole chart does. The constraint is exact, not a penalty.
struct Unknowns {
    std::size_t count = 0;
    std::vector<std::array<std::uint32_t, 3>> of_point;  ///< number of the unknown, per axis

    [[nodiscard]] bool shared(std::uint32_t a, std::uint32_t b, std::size_t axis) const {
        return of_point[a].at(axis) == of_point[b].at(axis);
    }
};

/// Unknowns are numbered by the first point that has them, axis by axis.
[[nodiscard]] Unknowns unknowns_of(const LabelledTets& tets);

/// The rows that FoldoverEnergy wants.
[[nodiscard]] std::vector<TetUnknowns> rows_of(const Unknowns& unknowns,
                                               const std::vector<tets::Tet>& tets);

/// Splits, at their middles, the edges that no map can satisfy: edges inside a chart whose ends
/// share two coordinates, and inner edges whose ends share one (the fan of tets around such an edge
/// would have to fit into a plane), and inner edges across from an edge of the surface in a tet
/// that has two facets on the boundary (it would have to be inverted where the charts meet in a
/// concave edge). Until none is left, at most a fixed number of passes. Returns the number of
/// splits.
std::size_t split_bound_edges(LabelledTets& tets);

/// Splits these edges, inner ones and those of the surface, each at its middle; of edges that meet
/// in a tet only the first by number. Returns the number of splits.
std::size_t split_edges(LabelledTets& tets, std::vector<Edge> edges);

/// As split_edges(), again and again until every one is split.
std::size_t split_all(LabelledTets& tets, const std::vector<Edge>& edges);

/// Splits the edges opposite to corners of charts (points of three charts or more), in facets and
/// tets, once each: a chart that turns by 270 degrees about its corner needs two triangles there,
/// and the tets about it as many. Returns the number of splits.
std::size_t split_about_corners(LabelledTets& tets);

}  // namespace decomp::map
