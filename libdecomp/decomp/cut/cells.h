// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cut/complex.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/plane.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

/// The cells of the complex and how they are stored; seen by the .cpp files of this room only.
namespace decomp::cut {

/// A directed edge: twice the index of the edge, plus one when it runs backwards.
using Ref = std::int32_t;

[[nodiscard]] constexpr std::int32_t edge_of(Ref ref) { return ref / 2; }

[[nodiscard]] constexpr bool is_reversed(Ref ref) { return (ref & 1) != 0; }

[[nodiscard]] constexpr Ref reversed(Ref ref) { return ref ^ 1; }

/// Where a vertex lies, in terms of the input and the planes alone: its coordinates never depend on
/// how deep the cut was that made it.
struct VertexSource {
    enum class Kind : std::int32_t {
        EdgePlane,       ///< input points a, b; plane c
        FacetTwoPlanes,  ///< input triangle a; planes b, c
        ThreePlanes,     ///< planes a, b, c
    };
    Kind kind = Kind::EdgePlane;
    std::int32_t a = -1;
    std::int32_t b = -1;
    std::int32_t c = -1;
};

/// The line that carries an edge.
struct Line {
    enum class Kind : std::int32_t {
        InputEdge,   ///< input points a, b
        FacetPlane,  ///< input triangle a, plane b
        TwoPlanes,   ///< planes a, b
    };
    Kind kind = Kind::InputEdge;
    std::int32_t a = -1;
    std::int32_t b = -1;
};

/// A segment between two vertices. Once split it stays as the root of its pieces, so every face
/// that names it sees the new vertex: there are no T-junctions. from == to marks a lone vertex
/// inside a face.
struct Edge {
    std::int32_t from = -1;
    std::int32_t to = -1;
    Line line;
    std::array<Ref, 2> children{-1, -1};

    [[nodiscard]] bool is_leaf() const { return children[0] < 0; }

    [[nodiscard]] bool is_lone_vertex() const { return from == to; }
};

/// What a face lies in: an input triangle or a plane.
struct Carrier {
    std::int32_t index = -1;
    bool is_plane = false;
};

/// A connected planar polygon, holes allowed, between two regions. Its edges run counter-clockwise
/// about the normal of its carrier, which points from inside to outside.
struct Face {
    Carrier carrier;
    std::int32_t inside = -1;
    std::int32_t outside = -1;
    std::uint32_t begin = 0;  ///< range in Cells::loops
    std::uint32_t count = 0;

    [[nodiscard]] bool bounds(std::int32_t region) const {
        return inside == region || outside == region;
    }
};

/// One use of a face by a region: flipped when the region is on the outside of the face.
struct FaceSide {
    std::int32_t face = -1;
    bool flipped = false;
};

struct Cells {
    std::shared_ptr<const mesh::TriMesh> input;  ///< coincident points welded
    std::vector<Eigen::Vector3d>
        points;  ///< of every vertex, each coordinate the nearest double to the exact one
    std::vector<VertexSource> implicit;  ///< of the vertices after the input's
    std::vector<part::Plane> planes;
    std::vector<Edge> edges;
    std::vector<Face> faces;
    std::vector<Ref> loops;
    std::int32_t regions = 0;

    [[nodiscard]] std::int32_t input_count() const {
        return static_cast<std::int32_t>(input->points.size());
    }

    [[nodiscard]] bool is_input(std::int32_t vertex) const { return vertex < input_count(); }

    [[nodiscard]] const VertexSource& source(std::int32_t vertex) const {
        return implicit[static_cast<std::size_t>(vertex - input_count())];
    }

    [[nodiscard]] const Edge& edge(Ref ref) const {
        return edges[static_cast<std::size_t>(edge_of(ref))];
    }

    [[nodiscard]] std::int32_t tail(Ref ref) const {
        return is_reversed(ref) ? edge(ref).to : edge(ref).from;
    }

    [[nodiscard]] std::int32_t head(Ref ref) const {
        return is_reversed(ref) ? edge(ref).from : edge(ref).to;
    }

    [[nodiscard]] const Eigen::Vector3d& point(std::int32_t vertex) const {
        return points[static_cast<std::size_t>(vertex)];
    }

    [[nodiscard]] const Face& face(std::int32_t index) const {
        return faces[static_cast<std::size_t>(index)];
    }

    /// The unsplit edges of a face, in the order of its loop; lone vertices included. Clears
    /// `leaves` first.
    void expand(const Face& face, std::vector<Ref>& leaves) const {
        leaves.clear();
        append_leaves(face, leaves);
    }

    /// The same, after what is there.
    void append_leaves(const Face& face, std::vector<Ref>& leaves) const {
        for (std::uint32_t i = face.begin; i < face.begin + face.count; ++i) {
            if (edge(loops[i]).is_leaf()) {
                leaves.push_back(loops[i]);
            } else {
                expand_edge(loops[i], leaves);
            }
        }
    }

    std::int32_t add_face(Carrier carrier, std::int32_t inside, std::int32_t outside,
                          const std::vector<Ref>& loop);
    void set_loop(std::int32_t face, const std::vector<Ref>& loop);
    Ref add_edge(std::int32_t from, std::int32_t to, Line line);

    /// The vertex where `line` crosses plane `plane`.
    std::int32_t add_vertex(const Line& line, std::int32_t plane);

  private:
    void expand_edge(Ref ref, std::vector<Ref>& leaves) const;
};

/// The line in which `carrier` meets plane `plane`.
[[nodiscard]] Line line_of(Carrier carrier, std::int32_t plane);

struct Complex::State : Cells {
    std::vector<Step> steps;
};

}  // namespace decomp::cut
