// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/cut/cells.h"
#include "decomp/cut/exact.h"
#include "decomp/cut/planar.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

/// Inside the room: one split of one region.
namespace decomp::cut {

/// {-1, vertex} for one that was there before the split, else kind and numbers of its source.
using VertexKey = std::array<std::int32_t, 4>;
using SegmentKey = std::pair<VertexKey, VertexKey>;

/// A connected piece of the cross-section of a region.
struct SectionPart {
    SectionPiece piece;
    std::vector<SegmentKey> loop;  ///< its edges, as the loop of the cap runs them
    std::vector<VertexKey> lone;
    std::vector<std::int32_t> faces;  ///< that its edges run in
};

/// Bits for the signs that the vertices of a face have.
inline constexpr unsigned kMetBelow = 1;
inline constexpr unsigned kMetOn = 2;
inline constexpr unsigned kMetAbove = 4;

enum Side : std::int8_t { Below = -1, On = 0, Above = 1, Unknown = 2 };

class Splitter {
  public:
    Splitter(Cells& cells, std::int32_t region, std::int32_t plane)
        : cells_(cells),
          region_(region),
          plane_(plane),
          before_{cells.points.size(),
                  cells.implicit.size(),
                  cells.edges.size(),
                  cells.faces.size(),
                  cells.loops.size(),
                  {},
                  {}},
          signs_(cells.points.size(), Unknown) {}

    /// @return ids of the regions, or the region itself where the plane misses it
    Result<std::vector<std::int32_t>> run();

    /// The caps that run() made, each with what it takes to make it alone.
    [[nodiscard]] Result<std::vector<SectionPart>> section() const;

    /// As run(), but only these caps of it are made; together they must take the region apart.
    Result<std::vector<std::int32_t>> run_limited(const std::vector<SectionPart>& chosen);

  private:
    /// What the cells held before.
    struct Before {
        std::size_t points;
        std::size_t implicit;
        std::size_t edges;
        std::size_t faces;
        std::size_t loops;
        std::vector<std::pair<std::int32_t, Face>>
            changed;                      ///< faces that now hold one of their pieces
        std::vector<std::int32_t> split;  ///< edges that were leaves
    };

    /// A vertex by its origin: the same one whether or not other pieces are cut as well.
    [[nodiscard]] VertexKey key(std::int32_t vertex) const;
    [[nodiscard]] SegmentKey segment(Ref ref) const;
    [[nodiscard]] Result<SectionPart> describe(std::int32_t cap) const;
    Status close_limited(const std::vector<SectionPart>& chosen);
    Result<std::vector<std::int32_t>> label_limited();

    /// Takes everything back.
    tl::unexpected<Error> undone(const Error& error);

    [[nodiscard]] Side sign(std::int32_t vertex) const {
        return signs_[static_cast<std::size_t>(vertex)];
    }

    /// Signs of all vertices of the region; false when the plane does not separate them.
    bool classify(const std::vector<FaceSide>& sides);

    Side known_sign(std::int32_t vertex);

    /// Puts a face on its side, cutting it if it has both.
    Status place(const FaceSide& side, unsigned met);

    void keep(const FaceSide& side, Side where) {
        (where == Above ? above_ : below_).push_back(side);
    }

    /// The rim of the half `where` runs along `leaf`, which is given as the face runs it.
    void add_rim(Ref leaf, const FaceSide& side, Side where);

    /// Splits a leaf that crosses the plane; the children serve every other face that shares it.
    void cut_edge(Ref leaf);

    /// Cuts every crossing leaf of the face and lists the new leaves.
    void cut_edges(std::int32_t face);

    /// Side of a leaf after cut_edges; On for one in the plane.
    [[nodiscard]] Side side_of(Ref leaf) const;

    /// A piece of an input triangle: the line cuts it in two convex pieces.
    Status cut_convex(const FaceSide& side);

    /// A piece of a plane: any polygon. The leaves of one side are closed along the line, from
    /// vertex to vertex, by as much as the flow through the vertices before asks for.
    Status cut_polygon(const FaceSide& side);

    /// Leaves that end at a vertex minus leaves that start there.
    [[nodiscard]] int inflow(const std::vector<Ref>& leaves, std::int32_t vertex) const;

    /// The leaf that joins two vertices, directed from `a` to `b`, or -1.
    [[nodiscard]] Ref leaf_between(const std::vector<Ref>& leaves, std::int32_t a,
                                   std::int32_t b) const;

    Status add_polygons(const FaceSide& side, const std::vector<Ref>& upper,
                        const std::vector<Ref>& lower);

    [[nodiscard]] Result<std::vector<PlanarPiece>> pieces_of(const std::vector<Ref>& loop,
                                                             Projection projection) const;

    std::vector<Ref> with_lone_vertices(const PlanarPiece& piece);

    /// Adds the cap.
    Status close();

    /// Gives the bodies of both halves their region ids, the first one the id of the region itself.
    Result<std::vector<std::int32_t>> label();

    Cells& cells_;
    std::int32_t region_;
    std::int32_t plane_;
    Before before_;
    std::vector<Side> signs_;
    std::vector<std::uint8_t> met_;  ///< of each side
    std::vector<std::int32_t> on_plane_;
    std::vector<FaceSide> above_;
    std::vector<FaceSide> below_;
    std::vector<ChainEdge> rims_;
    std::vector<Ref> leaves_;
    std::vector<std::int32_t> caps_;
    std::vector<std::pair<std::int32_t, std::int32_t>> origins_;  ///< edge of a rim, face it ran in
};

}  // namespace decomp::cut
