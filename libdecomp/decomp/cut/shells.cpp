// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/shells.h"

#include "decomp/cut/construct.h"
#include "decomp/cut/planar.h"
#include "decomp/cut/volume.h"

#include <gmpxx.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace decomp::cut {

namespace {

using Rational = mpq_class;

constexpr double kUnitInLastPlace = 4e-16;

tl::unexpected<Error> not_a_volume(const char* what) {
    return fail("cut.not_a_volume", what, {}, "repair the mesh first");
}

/// Union-find with path halving; the root is the lowest member.
class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    std::int32_t find(std::int32_t i) {
        while (at(i) != i) {
            at(i) = at(at(i));
            i = at(i);
        }
        return i;
    }

    void unite(std::int32_t a, std::int32_t b) {
        a = find(a);
        b = find(b);
        at(std::max(a, b)) = std::min(a, b);
    }

  private:
    std::int32_t& at(std::int32_t i) { return parent_[static_cast<std::size_t>(i)]; }

    std::vector<std::int32_t> parent_;
};

/// Whether b lies less than half a turn counter-clockwise from a about the axis; ties count as such
/// when they point the same way.
bool in_first_half(const Vec<Rational>& axis, const Vec<Rational>& a, const Vec<Rational>& b) {
    const int turn = sgn(dot<Rational>(axis, cross<Rational>(a, b)));
    return turn > 0 || (turn == 0 && sgn(dot<Rational>(a, b)) > 0);
}

/// One use of an edge by a side.
struct Use {
    std::int32_t edge = -1;
    std::int32_t item = -1;
    bool forward = false;
};

/// Unites sides across the edges that more than two of them share.
Status unite_crowded(const Cells& cells, const std::vector<FaceSide>& sides,
                     std::vector<Use>& crowded, Sets& sets) {
    std::stable_sort(crowded.begin(), crowded.end(),
                     [](const Use& l, const Use& r) { return l.edge < r.edge; });
    for (std::size_t begin = 0, end = 0; begin < crowded.size(); begin = end) {
        std::vector<Wing> wings;
        for (end = begin; end < crowded.size() && crowded[end].edge == crowded[begin].edge; ++end) {
            const FaceSide& side = sides[static_cast<std::size_t>(crowded[end].item)];
            wings.push_back({cells.face(side.face).carrier, side.flipped, crowded[end].forward});
        }
        const Edge& edge = cells.edges[static_cast<std::size_t>(crowded[begin].edge)];
        const std::vector<std::int32_t> partner = partners(cells, edge.from, edge.to, wings);
        for (std::size_t i = 0; i < partner.size(); ++i) {
            if (partner[i] < 0) {
                return not_a_volume("the faces around an edge do not bound a volume");
            }
            sets.unite(crowded[begin + i].item,
                       crowded[begin + static_cast<std::size_t>(partner[i])].item);
        }
    }
    return {};
}

/// Calls body(Use) for every edge that a side uses, in order.
template <class Body>
void for_each_use(const Cells& cells, const std::vector<FaceSide>& sides, const Body& body) {
    std::vector<Ref> leaves;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        cells.expand(cells.face(sides[i].face), leaves);
        for (const Ref leaf : leaves) {
            if (!cells.edge(leaf).is_lone_vertex()) {
                body(Use{edge_of(leaf), static_cast<std::int32_t>(i),
                         is_reversed(leaf) == sides[i].flipped});
            }
        }
    }
}

/// Who uses an edge; `balance` is forward minus backward.
struct EdgeUses {
    std::int32_t first = -1;
    std::int32_t second = -1;
    std::int16_t count = 0;
    std::int16_t balance = 0;
};

/// The shell of each side: sides joined across edges.
Result<Bodies> shells_of(const Cells& cells, const std::vector<FaceSide>& sides) {
    std::vector<EdgeUses> uses(cells.edges.size());
    bool any_crowded = false;
    for_each_use(cells, sides, [&](const Use& use) {
        EdgeUses& u = uses[static_cast<std::size_t>(use.edge)];
        (u.count == 0 ? u.first : u.second) = use.item;
        ++u.count;
        u.balance = static_cast<std::int16_t>(u.balance + (use.forward ? 1 : -1));
        any_crowded = any_crowded || u.count > 2;
    });
    Sets sets(sides.size());
    bool closed = true;
    for (const EdgeUses& u : uses) {
        closed = closed && u.balance == 0;
        if (u.count == 2) {
            sets.unite(u.first, u.second);
        }
    }
    std::vector<Use> crowded;
    if (any_crowded) {
        for_each_use(cells, sides, [&](const Use& use) {
            if (uses[static_cast<std::size_t>(use.edge)].count > 2) {
                crowded.push_back(use);
            }
        });
    }
    if (!closed) {
        return not_a_volume("an edge does not have as many faces on its left as on its right");
    }
    if (Status done = unite_crowded(cells, sides, crowded, sets); !done) {
        return fail(done.error());
    }
    Bodies out;
    out.body.assign(sides.size(), -1);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto root = static_cast<std::size_t>(sets.find(static_cast<std::int32_t>(i)));
        out.body[i] = root == i ? out.count++ : out.body[root];
    }
    return out;
}

/// Order of a vertex coordinate against an exact value whose nearest double is known.
int compare_to(const Cells& cells, std::int32_t vertex, std::size_t axis, const Rational& value,
               double rounded) {
    const double x = cells.point(vertex)[static_cast<Eigen::Index>(axis)];
    // get_d truncates, so the given double is within one unit of the nearest one.
    const double slack = kUnitInLastPlace * std::abs(rounded);
    if (x < rounded - slack) {
        return -1;
    }
    if (x > rounded + slack) {
        return 1;
    }
    return sgn(Rational(exact_point<Rational>(cells, vertex)[axis] - value));
}

/// How often a shell winds about a point, by a ray in +Z; nothing when the ray meets an edge.
std::optional<int> winding_about(const Cells& cells, const Vec<Rational>& q,
                                 const std::vector<FaceSide>& shell) {
    const double qx = q[0].get_d();
    const double qy = q[1].get_d();
    int total = 0;
    std::vector<Ref> leaves;
    for (const FaceSide& side : shell) {
        const Face& face = cells.face(side.face);
        cells.expand(face, leaves);
        int around = 0;
        for (const Ref leaf : leaves) {
            const std::int32_t a = cells.tail(leaf);
            const std::int32_t b = cells.head(leaf);
            const bool a_below = compare_to(cells, a, 1, q[1], qy) <= 0;
            const bool b_below = compare_to(cells, b, 1, q[1], qy) <= 0;
            if (a_below == b_below ||
                (compare_to(cells, a, 0, q[0], qx) < 0 && compare_to(cells, b, 0, q[0], qx) < 0)) {
                continue;
            }
            const Vec<Rational> pa = exact_point<Rational>(cells, a);
            const Vec<Rational> pb = exact_point<Rational>(cells, b);
            const int left =
                sgn(Rational((pb[0] - pa[0]) * (q[1] - pa[1]) - (pb[1] - pa[1]) * (q[0] - pa[0])));
            if (left == 0) {
                return std::nullopt;
            }
            around += a_below && left > 0 ? 1 : 0;
            around -= b_below && left < 0 ? 1 : 0;
        }
        if (around == 0) {
            continue;
        }
        const ExactPlane<Rational> plane = exact_plane<Rational>(cells, face.carrier);
        const int above =
            sgn(Rational(plane.offset - dot<Rational>(plane.normal, q))) * sgn(plane.normal[2]);
        if (above == 0) {
            return std::nullopt;
        }
        total += above > 0 ? (side.flipped ? -around : around) : 0;
    }
    return total;
}

/// A point strictly inside a triangle of the face; `attempt` moves it.
Result<Vec<Rational>> point_in(const Cells& cells, const FaceSide& side, int attempt) {
    const Result<std::vector<VertexTriangle>> triangles =
        triangles_of(cells, cells.face(side.face));
    if (!triangles) {
        return fail(triangles.error());
    }
    const VertexTriangle& t = triangles->front();
    const Vec<Rational> a = exact_point<Rational>(cells, t[0]);
    const Vec<Rational> ab = minus<Rational>(exact_point<Rational>(cells, t[1]), a);
    const Vec<Rational> ac = minus<Rational>(exact_point<Rational>(cells, t[2]), a);
    const Rational s(37 + attempt, 113);
    const Rational r(29 + 2 * attempt, 211);
    Vec<Rational> out;
    for (std::size_t k = 0; k < 3; ++k) {
        out[k] = a[k] + s * ab[k] + r * ac[k];
    }
    return out;
}

/// The smallest solid shell around a void.
Result<std::int32_t> owner_of(const Cells& cells, const std::vector<FaceSide>& hollow,
                              const std::vector<std::vector<FaceSide>>& shells,
                              const std::vector<int>& signs) {
    std::int32_t owner = -1;
    double owner_volume = 0;
    for (std::size_t i = 0; i < shells.size(); ++i) {
        if (signs[i] < 0) {
            continue;
        }
        std::optional<int> winding;
        for (int attempt = 0; attempt < 30 && !winding; ++attempt) {
            const Result<Vec<Rational>> q = point_in(cells, hollow.front(), attempt);
            if (!q) {
                return fail(q.error());
            }
            winding = winding_about(cells, *q, shells[i]);
        }
        const double volume = approximate_volume(cells, shells[i]);
        if (winding && *winding > 0 && (owner < 0 || volume < owner_volume)) {
            owner = static_cast<std::int32_t>(i);
            owner_volume = volume;
        }
    }
    if (owner < 0) {
        return not_a_volume("an inward shell lies in no outward one");
    }
    return owner;
}

}  // namespace

std::vector<std::int32_t> partners(const Cells& cells, std::int32_t from, std::int32_t to,
                                   const std::vector<Wing>& wings) {
    const Vec<Rational> axis =
        minus<Rational>(exact_point<Rational>(cells, to), exact_point<Rational>(cells, from));
    // Directions into the faces, at right angles to the edge: to the left of travel, seen from
    // outside.
    std::vector<Vec<Rational>> into;
    for (const Wing& wing : wings) {
        Vec<Rational> t = cross<Rational>(exact_plane<Rational>(cells, wing.carrier).normal, axis);
        if (wing.flipped == wing.forward) {
            t = {Rational(-t[0]), Rational(-t[1]), Rational(-t[2])};
        }
        into.push_back(t);
    }
    std::vector<std::int32_t> order(wings.size());
    std::iota(order.begin(), order.end(), 0);
    const auto direction = [&](std::int32_t i) -> const Vec<Rational>& {
        return into[static_cast<std::size_t>(i)];
    };
    std::stable_sort(order.begin(), order.end(), [&](std::int32_t l, std::int32_t r) {
        const bool l_first = in_first_half(axis, direction(0), direction(l));
        const bool r_first = in_first_half(axis, direction(0), direction(r));
        if (l_first != r_first) {
            return l_first;
        }
        const int turn = sgn(dot<Rational>(axis, cross<Rational>(direction(l), direction(r))));
        // The two sides of one face: the material lies outside of the slit between them.
        return turn > 0 || (turn == 0 && wings[static_cast<std::size_t>(l)].forward &&
                            !wings[static_cast<std::size_t>(r)].forward);
    });
    // The material lies clockwise of a forward wing and counter-clockwise of a backward one.
    std::vector<std::int32_t> out(wings.size(), -1);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto wing = static_cast<std::size_t>(order[i]);
        const auto before = static_cast<std::size_t>(order[(i + order.size() - 1) % order.size()]);
        if (wings[wing].forward && !wings[before].forward) {
            out[wing] = static_cast<std::int32_t>(before);
            out[before] = static_cast<std::int32_t>(wing);
        }
    }
    return out;
}

std::vector<FaceSide> sides_of(const Cells& cells, std::int32_t region) {
    std::vector<FaceSide> out;
    for (std::size_t i = 0; i < cells.faces.size(); ++i) {
        if (cells.faces[i].bounds(region)) {
            out.push_back({static_cast<std::int32_t>(i), cells.faces[i].inside != region});
        }
    }
    return out;
}

Result<Bodies> bodies_of(const Cells& cells, const std::vector<FaceSide>& sides) {
    Result<Bodies> found = shells_of(cells, sides);
    if (!found || found->count == 1) {
        return found;
    }
    std::vector<std::vector<FaceSide>> shells(static_cast<std::size_t>(found->count));
    for (std::size_t i = 0; i < sides.size(); ++i) {
        shells[static_cast<std::size_t>(found->body[i])].push_back(sides[i]);
    }
    std::vector<int> signs;
    signs.reserve(shells.size());
    for (const std::vector<FaceSide>& shell : shells) {
        signs.push_back(volume_sign(cells, shell));
    }
    std::vector<std::int32_t> owner(shells.size());
    std::iota(owner.begin(), owner.end(), 0);
    for (std::size_t i = 0; i < shells.size(); ++i) {
        if (signs[i] < 0) {
            const Result<std::int32_t> around = owner_of(cells, shells[i], shells, signs);
            if (!around) {
                return fail(around.error());
            }
            owner[i] = *around;
        }
    }
    Bodies out;
    out.body.assign(sides.size(), -1);
    std::vector<std::int32_t> number(shells.size(), -1);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        std::int32_t& n =
            number[static_cast<std::size_t>(owner[static_cast<std::size_t>(found->body[i])])];
        n = n < 0 ? out.count++ : n;
        out.body[i] = n;
    }
    return out;
}

}  // namespace decomp::cut
