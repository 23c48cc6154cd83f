// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/shells.h"
#include "decomp/cut/split.h"
#include "decomp/cut/splitter.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

// A split limited to some pieces of the cross-section is the whole split with less done: only the
// faces that the rims of these pieces run in are cut, and only these pieces become caps. The whole
// split, made on a copy, says which faces and which rims those are.
namespace decomp::cut {

namespace {

/// Bodies that stay together when only the chosen caps are made.
class Groups {
  public:
    explicit Groups(std::int32_t count) : parent_(static_cast<std::size_t>(count)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    std::int32_t of(std::int32_t body) {
        while (parent_[static_cast<std::size_t>(body)] != body) {
            body = parent_[static_cast<std::size_t>(body)];
        }
        return body;
    }

    void join(std::int32_t a, std::int32_t b) {
        a = of(a);
        b = of(b);
        parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }

  private:
    std::vector<std::int32_t> parent_;
};

}  // namespace

VertexKey Splitter::key(std::int32_t vertex) const {
    if (vertex < static_cast<std::int32_t>(before_.points)) {
        return {-1, vertex, 0, 0};
    }
    const VertexSource& source = cells_.source(vertex);
    return {static_cast<std::int32_t>(source.kind), source.a, source.b, source.c};
}

SegmentKey Splitter::segment(Ref ref) const {
    return {key(cells_.tail(ref)), key(cells_.head(ref))};
}

Result<SectionPart> Splitter::describe(std::int32_t cap) const {
    SectionPart out;
    const Face& face = cells_.face(cap);
    const Result<std::vector<VertexTriangle>> triangles = triangles_of(cells_, face);
    if (!triangles) {
        return fail(triangles.error());
    }
    double largest = -1;
    for (const VertexTriangle& t : *triangles) {
        const Eigen::Vector3d& a = cells_.point(t[0]);
        const Eigen::Vector3d& b = cells_.point(t[1]);
        const Eigen::Vector3d& c = cells_.point(t[2]);
        const double area = (b - a).cross(c - a).norm() / 2;
        out.piece.area_mm2 += area;
        if (area > largest) {
            largest = area;
            out.piece.inside_mm = (a + b + c) / 3;
        }
    }
    out.piece.below = face.inside;
    out.piece.above = face.outside;
    std::vector<Ref> leaves;
    cells_.expand(face, leaves);
    std::set<std::int32_t> edges;
    for (const Ref leaf : leaves) {
        if (cells_.edge(leaf).is_lone_vertex()) {
            out.lone.push_back(key(cells_.tail(leaf)));
        } else {
            out.loop.push_back(segment(leaf));
            edges.insert(edge_of(leaf));
        }
    }
    for (const auto& [edge, origin] : origins_) {
        if (edges.contains(edge)) {
            out.faces.push_back(origin);
        }
    }
    std::sort(out.faces.begin(), out.faces.end());
    out.faces.erase(std::unique(out.faces.begin(), out.faces.end()), out.faces.end());
    return out;
}

Result<std::vector<SectionPart>> Splitter::section() const {
    std::vector<SectionPart> out;
    for (const std::int32_t cap : caps_) {
        Result<SectionPart> part = describe(cap);
        if (!part) {
            return fail(part.error());
        }
        out.push_back(std::move(*part));
    }
    return out;
}

Result<std::vector<std::int32_t>> Splitter::run_limited(const std::vector<SectionPart>& chosen) {
    std::set<std::int32_t> cut;
    for (const SectionPart& part : chosen) {
        cut.insert(part.faces.begin(), part.faces.end());
    }
    const std::vector<FaceSide> sides = sides_of(cells_, region_);
    if (!classify(sides)) {
        return std::vector<std::int32_t>{region_};
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const bool crosses = (met_[i] & kMetAbove) != 0 && (met_[i] & kMetBelow) != 0;
        if (crosses && !cut.contains(sides[i].face)) {
            keep(sides[i], Below);
        } else if (Status done = place(sides[i], met_[i]); !done) {
            return undone(done.error());
        }
    }
    if (Status done = close_limited(chosen); !done) {
        return undone(done.error());
    }
    Result<std::vector<std::int32_t>> ids = label_limited();
    return ids ? ids : undone(ids.error());
}

Status Splitter::close_limited(const std::vector<SectionPart>& chosen) {
    std::map<SegmentKey, Ref> rims;
    std::map<VertexKey, std::int32_t> lone;
    for (const ChainEdge& rim : rims_) {
        rims.emplace(segment(rim.ref), rim.ref);
        rims.emplace(segment(reversed(rim.ref)), reversed(rim.ref));
    }
    for (const std::int32_t vertex : on_plane_) {
        lone.emplace(key(vertex), vertex);
    }
    for (const SectionPart& part : chosen) {
        PlanarPiece piece;
        for (const SegmentKey& segment : part.loop) {
            const auto found = rims.find(segment);
            if (found == rims.end()) {
                return fail("cut.no_such_piece", "the rim of a piece is not where it was");
            }
            piece.loop.push_back(found->second);
        }
        for (const VertexKey& vertex : part.lone) {
            const auto found = lone.find(vertex);
            if (found == lone.end()) {
                return fail("cut.no_such_piece", "a point of a piece is not where it was");
            }
            piece.lone.push_back(found->second);
        }
        const std::int32_t face =
            cells_.add_face({plane_, true}, region_, region_, with_lone_vertices(piece));
        below_.push_back({face, false});
        above_.push_back({face, true});
        caps_.push_back(face);
    }
    return {};
}

Result<std::vector<std::int32_t>> Splitter::label_limited() {
    std::vector<FaceSide> sides = below_;
    sides.insert(sides.end(), above_.begin(), above_.end());
    const Result<Bodies> bodies = bodies_of(cells_, sides);
    if (!bodies) {
        return fail(bodies.error());
    }
    std::vector<std::int32_t> ids(static_cast<std::size_t>(bodies->count));
    ids[0] = region_;
    std::iota(ids.begin() + 1, ids.end(), cells_.regions);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        Face& face = cells_.faces[static_cast<std::size_t>(sides[i].face)];
        (sides[i].flipped ? face.outside : face.inside) =
            ids[static_cast<std::size_t>(bodies->body[i])];
    }
    for (const std::int32_t cap : caps_) {
        if (cells_.face(cap).inside == cells_.face(cap).outside) {
            return fail("cut.no_such_piece", "a piece does not take the region apart");
        }
    }
    cells_.regions += bodies->count - 1;
    return ids;
}

Result<std::vector<SectionPart>> section_of(const Cells& cells, std::int32_t region,
                                            std::int32_t plane) {
    Cells copy = cells;
    Splitter splitter(copy, region, plane);
    const Result<std::vector<std::int32_t>> ids = splitter.run();
    if (!ids) {
        return fail(ids.error());
    }
    if (ids->size() < 2) {
        return std::vector<SectionPart>{};
    }
    Result<std::vector<SectionPart>> parts = splitter.section();
    if (parts) {
        const auto number = [&](std::int32_t id) {
            return static_cast<std::int32_t>(std::find(ids->begin(), ids->end(), id) -
                                             ids->begin());
        };
        for (SectionPart& part : *parts) {
            part.piece.below = number(part.piece.below);
            part.piece.above = number(part.piece.above);
        }
    }
    return parts;
}

Result<std::vector<std::int32_t>> split_region_at(Cells& cells, std::int32_t region,
                                                  std::int32_t plane,
                                                  const std::vector<SectionPart>& section,
                                                  const std::vector<std::int32_t>& pieces) {
    std::int32_t bodies = 0;
    for (const SectionPart& part : section) {
        bodies = std::max({bodies, part.piece.below + 1, part.piece.above + 1});
    }
    std::vector<char> wanted(section.size(), 0);
    for (const std::int32_t piece : pieces) {
        if (piece < 0 || static_cast<std::size_t>(piece) >= section.size()) {
            return fail("cut.no_such_piece",
                        "the cross-section has " + std::to_string(section.size()) + " pieces");
        }
        wanted[static_cast<std::size_t>(piece)] = 1;
    }
    Groups groups(bodies);
    for (std::size_t i = 0; i < section.size(); ++i) {
        if (wanted[i] == 0) {
            groups.join(section[i].piece.below, section[i].piece.above);
        }
    }
    std::vector<SectionPart> chosen;
    for (const SectionPart& part : section) {
        if (groups.of(part.piece.below) != groups.of(part.piece.above)) {
            chosen.push_back(part);
        }
    }
    if (chosen.empty()) {
        return std::vector<std::int32_t>{region};
    }
    if (chosen.size() == section.size()) {
        return split_region(cells, region, plane);
    }
    return Splitter(cells, region, plane).run_limited(chosen);
}

}  // namespace decomp::cut
