// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/split.h"

#include "decomp/cut/shells.h"
#include "decomp/cut/splitter.h"

#include <algorithm>
#include <numeric>
#include <utility>

// How a region is split, seen along the plane:
//
//        above ___________            1. every vertex of the region gets a sign, exactly
//             /     |     \           2. faces with both signs are cut along their line with the
//             plane; the edges
//   - - - - -x======x======x- - -        in the plane (==) form two chains, the rims of the two
//   open halves
//             \     |     /           3. where both chains enclose material there is cap; faces
//             that lie in the
//        below ‾‾‾‾‾‾‾‾‾‾‾               plane enclose it in one chain only and stay as they are
//                                     4. both halves are taken apart into bodies
namespace decomp::cut {

Result<std::vector<std::int32_t>> Splitter::run() {
    const std::vector<FaceSide> sides = sides_of(cells_, region_);
    if (!classify(sides)) {
        return std::vector<std::int32_t>{region_};
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (Status done = place(sides[i], met_[i]); !done) {
            return undone(done.error());
        }
    }
    if (Status done = close(); !done) {
        return undone(done.error());
    }
    Result<std::vector<std::int32_t>> ids = label();
    return ids ? ids : undone(ids.error());
}

tl::unexpected<Error> Splitter::undone(const Error& error) {
    for (const std::int32_t edge : before_.split) {
        cells_.edges[static_cast<std::size_t>(edge)].children = {-1, -1};
    }
    for (const auto& [index, face] : before_.changed) {
        cells_.faces[static_cast<std::size_t>(index)] = face;
    }
    cells_.points.resize(before_.points);
    cells_.implicit.resize(before_.implicit);
    cells_.edges.resize(before_.edges);
    cells_.faces.resize(before_.faces);
    cells_.loops.resize(before_.loops);
    return fail(error);
}

bool Splitter::classify(const std::vector<FaceSide>& sides) {
    unsigned all = 0;
    met_.reserve(sides.size());
    for (const FaceSide& side : sides) {
        cells_.expand(cells_.face(side.face), leaves_);
        unsigned met = 0;
        for (const Ref leaf : leaves_) {
            met |= 1U << static_cast<unsigned>(known_sign(cells_.tail(leaf)) + 1);
        }
        met_.push_back(static_cast<std::uint8_t>(met));
        all |= met;
    }
    return (all & kMetAbove) != 0 && (all & kMetBelow) != 0;
}

Side Splitter::known_sign(std::int32_t vertex) {
    Side& s = signs_[static_cast<std::size_t>(vertex)];
    if (s == Unknown) {
        s = static_cast<Side>(side_of_plane(cells_, vertex, plane_));
        if (s == On) {
            on_plane_.push_back(vertex);
        }
    }
    return s;
}

Status Splitter::place(const FaceSide& side, unsigned met) {
    const bool above = (met & kMetAbove) != 0;
    const bool below = (met & kMetBelow) != 0;
    if (above != below && (met & kMetOn) == 0) {
        keep(side, above ? Above : Below);
        return {};
    }
    cells_.expand(cells_.face(side.face), leaves_);
    if (above && below) {
        return cells_.face(side.face).carrier.is_plane ? cut_polygon(side) : cut_convex(side);
    }
    if (!above &&
        !below) {  // in the plane: the material is on the side away from the outward normal
        const int along = compare_directions(cells_, cells_.face(side.face).carrier, plane_);
        keep(side, (along > 0) != side.flipped ? Below : Above);
        return {};
    }
    const Side where = above ? Above : Below;
    keep(side, where);
    for (const Ref leaf : leaves_) {
        if (sign(cells_.tail(leaf)) == On && sign(cells_.head(leaf)) == On &&
            !cells_.edge(leaf).is_lone_vertex()) {
            add_rim(leaf, side, where);
        }
    }
    return {};
}

void Splitter::add_rim(Ref leaf, const FaceSide& side, Side where) {
    const Ref ref = side.flipped ? reversed(leaf) : leaf;
    rims_.push_back({ref, static_cast<std::int8_t>(where == Above ? 1 : 0),
                     static_cast<std::int8_t>(where == Below ? 1 : 0)});
    origins_.emplace_back(edge_of(ref), side.face);
}

void Splitter::cut_edge(Ref leaf) {
    const std::int32_t index = edge_of(leaf);
    const Edge edge = cells_.edges[static_cast<std::size_t>(index)];
    before_.split.push_back(index);
    const std::int32_t vertex = cells_.add_vertex(edge.line, plane_);
    signs_.push_back(On);
    const Ref first = cells_.add_edge(edge.from, vertex, edge.line);
    const Ref second = cells_.add_edge(vertex, edge.to, edge.line);
    cells_.edges[static_cast<std::size_t>(index)].children = {first, second};
}

void Splitter::cut_edges(std::int32_t face) {
    for (const Ref leaf : leaves_) {
        if (sign(cells_.tail(leaf)) * sign(cells_.head(leaf)) < 0 && cells_.edge(leaf).is_leaf()) {
            cut_edge(leaf);
        }
    }
    cells_.expand(cells_.face(face), leaves_);
}

Side Splitter::side_of(Ref leaf) const {
    const Side tail = sign(cells_.tail(leaf));
    return tail != On ? tail : sign(cells_.head(leaf));
}

Status Splitter::cut_convex(const FaceSide& side) {
    cut_edges(side.face);
    std::size_t start = 0;
    while (side_of(leaves_[start]) != Above ||
           side_of(leaves_[(start + leaves_.size() - 1) % leaves_.size()]) == Above) {
        ++start;
    }
    std::rotate(leaves_.begin(), leaves_.begin() + static_cast<std::ptrdiff_t>(start),
                leaves_.end());
    std::vector<Ref> upper;
    std::vector<Ref> lower;
    for (const Ref leaf : leaves_) {
        (side_of(leaf) == Above ? upper : lower).push_back(leaf);
    }
    const Face face = cells_.face(side.face);
    const Ref closing = cells_.add_edge(cells_.head(upper.back()), cells_.tail(upper.front()),
                                        line_of(face.carrier, plane_));
    upper.push_back(closing);
    lower.push_back(reversed(closing));
    before_.changed.emplace_back(side.face, face);
    cells_.set_loop(side.face, upper);
    const std::int32_t other = cells_.add_face(face.carrier, face.inside, face.outside, lower);
    keep(side, Above);
    keep({other, side.flipped}, Below);
    add_rim(closing, side, Above);
    add_rim(reversed(closing), side, Below);
    return {};
}

Status Splitter::cut_polygon(const FaceSide& side) {
    cut_edges(side.face);
    const std::vector<Ref> leaves = leaves_;
    std::vector<std::int32_t> on_line;
    for (const Ref leaf : leaves) {
        if (sign(cells_.tail(leaf)) == On) {
            on_line.push_back(cells_.tail(leaf));
        }
    }
    std::sort(on_line.begin(), on_line.end());
    on_line.erase(std::unique(on_line.begin(), on_line.end()), on_line.end());
    std::sort(on_line.begin(), on_line.end(),
              [&](std::int32_t a, std::int32_t b) { return lexicographically_less(cells_, a, b); });
    std::vector<Ref> upper;
    std::vector<Ref> lower;
    for (const Ref leaf : leaves) {
        if (side_of(leaf) != On) {
            (side_of(leaf) == Above ? upper : lower).push_back(leaf);
        }
    }
    int upper_flow = 0;
    int lower_flow = 0;
    const std::vector<Ref> upper_open = upper;
    const std::vector<Ref> lower_open = lower;
    const Carrier carrier = cells_.face(side.face).carrier;
    for (std::size_t i = 0; i + 1 < on_line.size(); ++i) {
        upper_flow += inflow(upper_open, on_line[i]);
        lower_flow += inflow(lower_open, on_line[i]);
        if (upper_flow == 0 && lower_flow == 0) {
            continue;
        }
        Ref ref = leaf_between(leaves, on_line[i], on_line[i + 1]);
        if (ref < 0 && (upper_flow == 0 || lower_flow == 0)) {
            return fail("cut.crossing_constraints", "a cap is not closed", {},
                        "repair the mesh first");
        }
        ref = ref < 0 ? cells_.add_edge(on_line[i], on_line[i + 1], line_of(carrier, plane_)) : ref;
        if (upper_flow != 0) {
            upper.push_back(upper_flow > 0 ? ref : reversed(ref));
            add_rim(upper.back(), side, Above);
        }
        if (lower_flow != 0) {
            lower.push_back(lower_flow > 0 ? ref : reversed(ref));
            add_rim(lower.back(), side, Below);
        }
    }
    return add_polygons(side, upper, lower);
}

int Splitter::inflow(const std::vector<Ref>& leaves, std::int32_t vertex) const {
    int flow = 0;
    for (const Ref leaf : leaves) {
        flow += (cells_.head(leaf) == vertex ? 1 : 0) - (cells_.tail(leaf) == vertex ? 1 : 0);
    }
    return flow;
}

Ref Splitter::leaf_between(const std::vector<Ref>& leaves, std::int32_t a, std::int32_t b) const {
    for (const Ref leaf : leaves) {
        if (cells_.tail(leaf) == a && cells_.head(leaf) == b) {
            return leaf;
        }
        if (cells_.tail(leaf) == b && cells_.head(leaf) == a) {
            return reversed(leaf);
        }
    }
    return -1;
}

Status Splitter::add_polygons(const FaceSide& side, const std::vector<Ref>& upper,
                              const std::vector<Ref>& lower) {
    const Face face = cells_.face(side.face);
    bool first = true;
    for (const auto& [loop, where] : {std::pair(&upper, Above), std::pair(&lower, Below)}) {
        const Result<std::vector<PlanarPiece>> pieces =
            pieces_of(*loop, projection_of(cells_, face.carrier));
        if (!pieces) {
            return fail(pieces.error());
        }
        for (const PlanarPiece& piece : *pieces) {
            const std::vector<Ref> boundary = with_lone_vertices(piece);
            if (first) {
                before_.changed.emplace_back(side.face, face);
                cells_.set_loop(side.face, boundary);
                keep(side, where);
            } else {
                keep({cells_.add_face(face.carrier, face.inside, face.outside, boundary),
                      side.flipped},
                     where);
            }
            first = false;
        }
    }
    return {};
}

Result<std::vector<PlanarPiece>> Splitter::pieces_of(const std::vector<Ref>& loop,
                                                     Projection projection) const {
    std::vector<ChainEdge> chain;
    std::vector<std::int32_t> lone;
    for (const Ref ref : loop) {
        if (cells_.edge(ref).is_lone_vertex()) {
            lone.push_back(cells_.tail(ref));
        } else {
            chain.push_back({ref, 1, -1});
        }
    }
    return common_pieces(cells_, projection, chain, lone);
}

std::vector<Ref> Splitter::with_lone_vertices(const PlanarPiece& piece) {
    std::vector<Ref> loop = piece.loop;
    for (const std::int32_t vertex : piece.lone) {
        loop.push_back(cells_.add_edge(vertex, vertex, {}));
    }
    return loop;
}

Status Splitter::close() {
    const Result<std::vector<PlanarPiece>> pieces =
        common_pieces(cells_, projection_of(cells_, {plane_, true}), rims_, on_plane_);
    if (!pieces) {
        return fail(pieces.error());
    }
    for (const PlanarPiece& piece : *pieces) {
        const std::int32_t face =
            cells_.add_face({plane_, true}, region_, region_, with_lone_vertices(piece));
        below_.push_back({face, false});
        above_.push_back({face, true});
        caps_.push_back(face);
    }
    return {};
}

Result<std::vector<std::int32_t>> Splitter::label() {
    std::vector<std::int32_t> ids;
    const Result<Bodies> below = bodies_of(cells_, below_);
    const Result<Bodies> above = bodies_of(cells_, above_);
    if (!below || !above) {
        return fail(below ? above.error() : below.error());
    }
    ids.resize(static_cast<std::size_t>(below->count) + static_cast<std::size_t>(above->count));
    ids[0] = region_;
    std::iota(ids.begin() + 1, ids.end(), cells_.regions);
    cells_.regions += static_cast<std::int32_t>(ids.size()) - 1;
    const auto write = [&](const std::vector<FaceSide>& sides, const Bodies& bodies,
                           std::size_t shift) {
        for (std::size_t i = 0; i < sides.size(); ++i) {
            Face& face = cells_.faces[static_cast<std::size_t>(sides[i].face)];
            (sides[i].flipped ? face.outside : face.inside) =
                ids[static_cast<std::size_t>(bodies.body[i]) + shift];
        }
    };
    write(below_, *below, 0);
    write(above_, *above, static_cast<std::size_t>(below->count));
    return ids;
}

Result<std::vector<std::int32_t>> split_region(Cells& cells, std::int32_t region,
                                               std::int32_t plane) {
    return Splitter(cells, region, plane).run();
}

}  // namespace decomp::cut
