// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/build.h"

#include "decomp/cut/exact.h"
#include "decomp/cut/shells.h"
#include "decomp/cut/volume.h"
#include "decomp/cut/written.h"

#include <algorithm>
#include <deque>
#include <map>
#include <tuple>
#include <utility>

namespace decomp::cut {

namespace {

using Ends = std::pair<std::int32_t, std::int32_t>;

Status check_points(const mesh::TriMesh& volume) {
    if (volume.triangles.empty()) {
        return fail("cut.not_a_volume", "the mesh has no triangle");
    }
    for (const mesh::Triangle& t : volume.triangles) {
        for (const std::uint32_t corner : t) {
            if (corner >= volume.points.size() || !volume.points[corner].allFinite()) {
                return fail("cut.not_a_volume",
                            "a triangle names a point that is missing or not finite");
            }
        }
    }
    return {};
}

/// Equal points become one and triangles that thereby lose a corner go; order is kept.
mesh::TriMesh welded(const mesh::TriMesh& mesh) {
    const std::vector<std::uint32_t> first = first_of_equal(mesh.points);
    mesh::TriMesh out;
    out.points = mesh.points;
    for (const mesh::Triangle& t : mesh.triangles) {
        const mesh::Triangle w{first[t[0]], first[t[1]], first[t[2]]};
        if (w[0] != w[1] && w[1] != w[2] && w[2] != w[0]) {
            out.triangles.push_back(w);
        }
    }
    return out;
}

/// The edges of the input, found by their ends.
class EdgeTable {
  public:
    explicit EdgeTable(Cells& cells) : cells_(cells) {}

    /// All edges of the triangles at once, in the order of first use.
    std::vector<std::array<Ref, 3>> add_all(const std::vector<mesh::Triangle>& triangles) {
        struct Use {
            Ends ends;
            std::uint32_t slot;
        };

        std::vector<Use> uses;
        uses.reserve(triangles.size() * 3);
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                uses.push_back(
                    {ends_of(triangles[i].at(k), triangles[i].at((k + 1) % 3)), 3 * i + k});
            }
        }
        std::sort(uses.begin(), uses.end(), [](const Use& l, const Use& r) {
            return std::tie(l.ends, l.slot) < std::tie(r.ends, r.slot);
        });
        std::vector<std::array<Ref, 3>> refs(triangles.size());
        cells_.edges.reserve(uses.size() / 2);
        for (std::size_t i = 0; i < uses.size(); ++i) {
            const Ends& ends = uses[i].ends;
            const bool same = i > 0 && uses[i - 1].ends == ends;
            const Ref ref = same ? 2 * static_cast<Ref>(cells_.edges.size() - 1) : add(ends);
            const mesh::Triangle& t = triangles[uses[i].slot / 3];
            const bool forward = static_cast<std::int32_t>(t.at(uses[i].slot % 3)) == ends.first;
            refs[uses[i].slot / 3].at(uses[i].slot % 3) = forward ? ref : reversed(ref);
        }
        return refs;
    }

    /// The edge from one vertex to another, found among the leaves' roots or made, on a given line.
    Ref between(std::int32_t from, std::int32_t to, const Line& line) {
        if (index_.empty()) {
            for (std::size_t i = 0; i < cells_.edges.size(); ++i) {
                index_.emplace(Ends(cells_.edges[i].from, cells_.edges[i].to),
                               2 * static_cast<Ref>(i));
            }
        }
        const Ends ends = std::minmax(from, to);
        auto found = index_.find(ends);
        if (found == index_.end()) {
            found = index_.emplace(ends, cells_.add_edge(ends.first, ends.second, line)).first;
        }
        return from == ends.first ? found->second : reversed(found->second);
    }

  private:
    static Ends ends_of(std::uint32_t a, std::uint32_t b) {
        return std::minmax(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
    }

    Ref add(const Ends& ends) {
        return cells_.add_edge(ends.first, ends.second,
                               {Line::Kind::InputEdge, ends.first, ends.second});
    }

    Cells& cells_;
    std::map<Ends, Ref> index_;
};

/// Whether w lies strictly between the ends of an edge, all three being on one line.
bool strictly_between(const Cells& cells, const Edge& edge, std::int32_t w) {
    return lexicographically_less(cells, edge.from, w) !=
               lexicographically_less(cells, edge.to, w) &&
           w != edge.from && w != edge.to;
}

/// Triangles without area carry no face, but their corners split their edges, so that the
/// neighbours stay joined.
class FlatTriangles {
  public:
    FlatTriangles(Cells& cells, EdgeTable& table) : cells_(cells), table_(table) {}

    void dissolve(const std::vector<std::vector<Ref>>& flats) {
        bool changed = true;
        while (changed) {
            changed = false;
            for (const std::vector<Ref>& flat : flats) {
                changed = split_one(flat) || changed;
            }
        }
    }

  private:
    /// Splits the first leaf that has a vertex of the same flat triangle strictly inside.
    bool split_one(const std::vector<Ref>& flat) {
        Face face;
        face.begin = static_cast<std::uint32_t>(cells_.loops.size());
        face.count = static_cast<std::uint32_t>(flat.size());
        cells_.loops.insert(cells_.loops.end(), flat.begin(), flat.end());
        std::vector<Ref> leaves;
        cells_.expand(face, leaves);
        cells_.loops.resize(face.begin);
        for (const Ref leaf : leaves) {
            for (const Ref other : leaves) {
                const Edge edge = cells_.edge(leaf);
                const std::int32_t w = cells_.tail(other);
                if (strictly_between(cells_, edge, w)) {
                    const Ref first = table_.between(edge.from, w, edge.line);
                    const Ref second = table_.between(w, edge.to, edge.line);
                    cells_.edges[static_cast<std::size_t>(edge_of(leaf))].children = {first,
                                                                                      second};
                    return true;
                }
            }
        }
        return false;
    }

    Cells& cells_;
    EdgeTable& table_;
};

}  // namespace

Status build_cells(const mesh::TriMesh& volume, Cells& cells) {
    if (Status sound = check_points(volume); !sound) {
        return sound;
    }
    auto input = std::make_shared<mesh::TriMesh>(welded(volume));
    cells.input = input;
    cells.points = input->points;
    EdgeTable table(cells);
    const std::vector<std::array<Ref, 3>> refs = table.add_all(input->triangles);
    std::vector<std::vector<Ref>> flats;
    std::vector<FaceSide> sides;
    cells.faces.reserve(refs.size());
    cells.loops.reserve(refs.size() * 3);
    for (std::size_t i = 0; i < refs.size(); ++i) {
        const std::vector<Ref> loop(refs[i].begin(), refs[i].end());
        if (is_flat(*input, input->triangles[i])) {
            flats.push_back(loop);
        } else {
            sides.push_back(
                {cells.add_face({static_cast<std::int32_t>(i), false}, 0, -1, loop), false});
        }
    }
    FlatTriangles(cells, table).dissolve(flats);
    const Result<Bodies> bodies = bodies_of(cells, sides);
    if (!bodies) {
        return fail(bodies.error());
    }
    if (bodies->count == 1 && volume_sign(cells, sides) <= 0) {
        return fail("cut.not_a_volume", "the mesh is inside out or encloses nothing", {},
                    "repair the mesh first");
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
        cells.faces[static_cast<std::size_t>(sides[i].face)].inside = bodies->body[i];
    }
    cells.regions = bodies->count;
    return {};
}

}  // namespace decomp::cut
