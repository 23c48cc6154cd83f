// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/planar.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_2.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <utility>

namespace decomp::cut {

namespace {

/// A vertex in the projection. CGAL asks everything of it through the traits, which go by the
/// vertex.
struct Site {
    std::int32_t vertex = -1;
};

/// Geometry for CGAL's triangulation: our own exact predicates on vertices.
struct SiteTraits {
    using Point_2 = Site;
    using Segment_2 = std::pair<Site, Site>;
    using Triangle_2 = std::array<Site, 3>;
    using FT = double;

    const Cells* cells = nullptr;
    Projection projection;

    struct Compare {
        const Cells* cells;
        int axis;

        CGAL::Comparison_result operator()(const Site& a, const Site& b) const {
            return CGAL::sign(compare_coordinate(*cells, a.vertex, b.vertex, axis));
        }
    };

    struct Less {
        Compare compare;

        bool operator()(const Site& a, const Site& b) const { return compare(a, b) < 0; }
    };

    struct Turn {
        const Cells* cells;
        Projection projection;

        CGAL::Orientation operator()(const Site& a, const Site& b, const Site& c) const {
            return CGAL::sign(turn(*cells, projection, a.vertex, b.vertex, c.vertex));
        }
    };

    struct Circle {
        const Cells* cells;
        Projection projection;

        CGAL::Oriented_side operator()(const Site& a, const Site& b, const Site& c,
                                       const Site& d) const {
            return CGAL::sign(
                in_circle(*cells, projection, {a.vertex, b.vertex, c.vertex, d.vertex}));
        }
    };

    struct Same {
        const Site& operator()(const Site& site) const { return site; }
    };

    using Compare_x_2 = Compare;
    using Compare_y_2 = Compare;
    using Less_x_2 = Less;
    using Less_y_2 = Less;
    using Orientation_2 = Turn;
    using Side_of_oriented_circle_2 = Circle;
    using Construct_point_2 = Same;

    // NOLINTBEGIN(readability-identifier-naming): the names are CGAL's
    [[nodiscard]] Compare compare_x_2_object() const { return {cells, projection.u}; }

    [[nodiscard]] Compare compare_y_2_object() const { return {cells, projection.v}; }

    [[nodiscard]] Less less_x_2_object() const { return {compare_x_2_object()}; }

    [[nodiscard]] Less less_y_2_object() const { return {compare_y_2_object()}; }

    [[nodiscard]] Turn orientation_2_object() const { return {cells, projection}; }

    [[nodiscard]] Circle side_of_oriented_circle_2_object() const { return {cells, projection}; }

    [[nodiscard]] static Same construct_point_2_object() { return {}; }

    // NOLINTEND(readability-identifier-naming)
};

struct Winding {
    int above = 0;
    int below = 0;
    int piece = -1;
    bool seen = false;

    [[nodiscard]] bool common() const { return above == 1 && below == -1; }

    [[nodiscard]] bool sound() const {
        return above >= 0 && above <= 1 && below <= 0 && below >= -1;
    }
};

using VertexBase = CGAL::Triangulation_vertex_base_2<SiteTraits>;
using FaceInfo = CGAL::Triangulation_face_base_with_info_2<Winding, SiteTraits>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<SiteTraits, FaceInfo>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<SiteTraits, Structure,
                                                            CGAL::No_constraint_intersection_tag>;

/// What all chain edges between two vertices add up to, along lower to higher vertex id.
struct Constraint {
    int above = 0;
    int below = 0;
    std::int32_t edge = -1;
};

using Constraints = std::map<std::pair<std::int32_t, std::int32_t>, Constraint>;

tl::unexpected<Error> crossing(const char* what) {
    return fail("cut.crossing_constraints", what, {},
                "the shape intersects itself here: repair it first");
}

Constraints constraints_of(const Cells& cells, const std::vector<ChainEdge>& chain) {
    Constraints out;
    for (const ChainEdge& item : chain) {
        const std::int32_t tail = cells.tail(item.ref);
        const std::int32_t head = cells.head(item.ref);
        const int sign = tail < head ? 1 : -1;
        Constraint& c = out[std::minmax(tail, head)];
        c.above += sign * item.above;
        c.below += sign * item.below;
        c.edge = edge_of(item.ref);
    }
    return out;
}

/// The arrangement of a chain as a constrained Delaunay triangulation with windings.
class Arrangement {
  public:
    Arrangement(const Cells& cells, Projection projection)
        : cells_(cells), delaunay_(SiteTraits{&cells, projection}) {}

    Status build(const std::vector<ChainEdge>& chain, const std::vector<std::int32_t>& lone) {
        constraints_ = constraints_of(cells_, chain);
        insert_points(lone);
        if (handles_.size() != count_) {
            return crossing("two vertices coincide");
        }
        try {
            for (const auto& [ends, constraint] : constraints_) {
                delaunay_.insert_constraint(handle(ends.first), handle(ends.second));
            }
        } catch (const Delaunay::Intersection_of_constraints_exception&) {
            return crossing("two edges of the cross-section cross");
        }
        return delaunay_.dimension() == 2 ? flood() : Status{};
    }

    [[nodiscard]] std::vector<VertexTriangle> triangles() const {
        std::vector<VertexTriangle> out;
        for (auto f = delaunay_.finite_faces_begin(); f != delaunay_.finite_faces_end(); ++f) {
            if (f->info().common()) {
                out.push_back({f->vertex(0)->point().vertex, f->vertex(1)->point().vertex,
                               f->vertex(2)->point().vertex});
            }
        }
        return out;
    }

    [[nodiscard]] std::vector<PlanarPiece> pieces() {
        std::vector<PlanarPiece> out;
        for (auto f = delaunay_.finite_faces_begin(); f != delaunay_.finite_faces_end(); ++f) {
            if (f->info().common() && f->info().piece < 0) {
                out.push_back(piece_from(f, static_cast<int>(out.size())));
            }
        }
        return out;
    }

  private:
    void insert_points(const std::vector<std::int32_t>& lone) {
        std::vector<std::int32_t> ids = lone;
        for (const auto& [ends, constraint] : constraints_) {
            ids.push_back(ends.first);
            ids.push_back(ends.second);
        }
        std::sort(ids.begin(), ids.end());
        ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
        std::vector<Site> sites;
        sites.reserve(ids.size());
        for (const std::int32_t id : ids) {
            sites.push_back({id});
        }
        delaunay_.insert(sites.begin(), sites.end());
        for (auto v = delaunay_.finite_vertices_begin(); v != delaunay_.finite_vertices_end();
             ++v) {
            handles_.emplace_back(v->point().vertex, v);
        }
        std::sort(handles_.begin(), handles_.end(),
                  [](const auto& l, const auto& r) { return l.first < r.first; });
        count_ = ids.size();
    }

    [[nodiscard]] Delaunay::Vertex_handle handle(std::int32_t vertex) const {
        return std::lower_bound(handles_.begin(), handles_.end(), vertex,
                                [](const auto& entry, std::int32_t v) { return entry.first < v; })
            ->second;
    }

    /// Spreads the windings from the outside.
    Status flood() {
        std::vector<Delaunay::Face_handle> open{delaunay_.infinite_face()};
        open.front()->info().seen = true;
        while (!open.empty()) {
            const Delaunay::Face_handle f = open.back();
            open.pop_back();
            for (int i = 0; i < 3; ++i) {
                if (Status step = flood_across(f, i, open); !step) {
                    return step;
                }
            }
        }
        return {};
    }

    /// Crossing a constraint from its left to its right takes its turns away.
    Status flood_across(Delaunay::Face_handle f, int i, std::vector<Delaunay::Face_handle>& open) {
        Winding across = f->info();
        across.seen = true;
        if (f->is_constrained(i)) {
            const std::int32_t tail = f->vertex(Delaunay::ccw(i))->point().vertex;
            const std::int32_t head = f->vertex(Delaunay::cw(i))->point().vertex;
            const auto found = constraints_.find(std::minmax(tail, head));
            if (found == constraints_.end()) {
                return crossing("a vertex lies on an edge of the cross-section");
            }
            const int sign = tail < head ? 1 : -1;
            across.above -= sign * found->second.above;
            across.below -= sign * found->second.below;
        }
        const Delaunay::Face_handle g = f->neighbor(i);
        if (!g->info().seen) {
            if (!across.sound()) {
                return crossing("the cross-section overlaps itself");
            }
            g->info() = across;
            open.push_back(g);
        } else if (g->info().above != across.above || g->info().below != across.below) {
            return crossing("the cross-section is not closed");
        }
        return {};
    }

    /// The edge of a constraint, turned to begin at `tail`.
    [[nodiscard]] Ref constraint_from(std::int32_t tail, std::int32_t head) const {
        const std::int32_t edge = constraints_.find(std::minmax(tail, head))->second.edge;
        return 2 * edge + (cells_.edges[static_cast<std::size_t>(edge)].from == tail ? 0 : 1);
    }

    PlanarPiece piece_from(Delaunay::Face_handle start, int index) {
        PlanarPiece piece;
        std::vector<Delaunay::Face_handle> open{start};
        std::vector<std::int32_t> on_edges;
        std::vector<std::int32_t> used;
        start->info().piece = index;
        while (!open.empty()) {
            const Delaunay::Face_handle f = open.back();
            open.pop_back();
            for (int i = 0; i < 3; ++i) {
                used.push_back(f->vertex(i)->point().vertex);
                if (f->is_constrained(i)) {
                    const std::int32_t tail = f->vertex(Delaunay::ccw(i))->point().vertex;
                    const std::int32_t head = f->vertex(Delaunay::cw(i))->point().vertex;
                    piece.loop.push_back(constraint_from(tail, head));
                    on_edges.push_back(tail);
                    on_edges.push_back(head);
                } else if (const Delaunay::Face_handle g = f->neighbor(i); g->info().piece < 0) {
                    g->info().piece = index;
                    open.push_back(g);
                }
            }
        }
        std::sort(piece.loop.begin(), piece.loop.end());
        std::sort(on_edges.begin(), on_edges.end());
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        std::set_difference(used.begin(), used.end(), on_edges.begin(), on_edges.end(),
                            std::back_inserter(piece.lone));
        return piece;
    }

    const Cells& cells_;
    Constraints constraints_;
    Delaunay delaunay_;
    std::vector<std::pair<std::int32_t, Delaunay::Vertex_handle>> handles_;  ///< by vertex
    std::size_t count_ = 0;
};

/// Smallest height of a triangle over its longest side, from rounded coordinates: how far it is
/// from being flat.
double roundness(const Cells& cells, const VertexTriangle& t) {
    const Eigen::Vector3d& a = cells.point(t[0]);
    const Eigen::Vector3d& b = cells.point(t[1]);
    const Eigen::Vector3d& c = cells.point(t[2]);
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return longest == 0 ? 0 : (b - a).cross(c - a).norm() / longest;
}

/// True when some three consecutive corners turn: the polygon is not a line.
bool has_area(const Cells& cells, Projection projection, const std::vector<std::int32_t>& polygon) {
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        if (turn(cells, projection, polygon[0], polygon[i], polygon[i + 1]) > 0) {
            return true;
        }
    }
    return false;
}

/// Cuts the roundest ear first; an ear counts only if what remains still has an area.
Result<std::vector<VertexTriangle>> clip_ears(const Cells& cells, Projection projection,
                                              std::vector<std::int32_t> polygon) {
    std::vector<VertexTriangle> out;
    while (polygon.size() > 3) {
        std::size_t best = polygon.size();
        double best_roundness = -1;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const std::int32_t before = polygon[(i + polygon.size() - 1) % polygon.size()];
            const std::int32_t after = polygon[(i + 1) % polygon.size()];
            const double r = roundness(cells, {before, polygon[i], after});
            if (r <= best_roundness || turn(cells, projection, before, polygon[i], after) <= 0) {
                continue;
            }
            std::vector<std::int32_t> rest = polygon;
            rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
            if (has_area(cells, projection, rest)) {
                best = i;
                best_roundness = r;
            }
        }
        if (best == polygon.size()) {
            return crossing("a face has no area");
        }
        out.push_back({polygon[(best + polygon.size() - 1) % polygon.size()], polygon[best],
                       polygon[(best + 1) % polygon.size()]});
        polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(best));
    }
    out.push_back({polygon[0], polygon[1], polygon[2]});
    return out;
}

}  // namespace

Result<std::vector<PlanarPiece>> common_pieces(const Cells& cells, Projection projection,
                                               const std::vector<ChainEdge>& chain,
                                               const std::vector<std::int32_t>& lone) {
    Arrangement arrangement(cells, projection);
    if (Status built = arrangement.build(chain, lone); !built) {
        return fail(built.error());
    }
    return arrangement.pieces();
}

Result<std::vector<VertexTriangle>> triangles_of(const Cells& cells, const Face& face) {
    std::vector<Ref> leaves;
    cells.expand(face, leaves);
    if (!face.carrier.is_plane) {
        std::vector<std::int32_t> polygon;
        polygon.reserve(leaves.size());
        for (const Ref leaf : leaves) {
            polygon.push_back(cells.tail(leaf));
        }
        if (polygon.size() == 3) {
            return std::vector<VertexTriangle>{{polygon[0], polygon[1], polygon[2]}};
        }
        return clip_ears(cells, projection_of(cells, face.carrier), std::move(polygon));
    }
    std::vector<ChainEdge> chain;
    std::vector<std::int32_t> lone;
    for (const Ref leaf : leaves) {
        if (cells.edge(leaf).is_lone_vertex()) {
            lone.push_back(cells.tail(leaf));
        } else {
            chain.push_back({leaf, 1, -1});
        }
    }
    Arrangement arrangement(cells, projection_of(cells, face.carrier));
    if (Status built = arrangement.build(chain, lone); !built) {
        return fail(built.error());
    }
    return arrangement.triangles();
}

}  // namespace decomp::cut
