// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/volume.h"

#include "decomp/cut/construct.h"
#include "decomp/cut/exact.h"

#include <gmpxx.h>

#include <cmath>
#include <unordered_map>

namespace decomp::cut {

namespace {

using Rational = mpq_class;

/// Relative to the sum of magnitudes of the cones; their rounding stays far below it.
constexpr double kVolumeFilter = 1e-9;

/// Exact points, each made once.
class ExactPoints {
  public:
    explicit ExactPoints(const Cells& cells) : cells_(cells) {}

    const Vec<Rational>& of(std::int32_t vertex) {
        const auto [entry, is_new] = known_.try_emplace(vertex);
        if (is_new) {
            entry->second = exact_point<Rational>(cells_, vertex);
        }
        return entry->second;
    }

  private:
    const Cells& cells_;
    std::unordered_map<std::int32_t, Vec<Rational>> known_;
};

/// Twice the area of the polygon in the projection, positive for a counter-clockwise one.
template <class F, class PointOf>
F doubled_area(const Cells& cells, Projection projection, const std::vector<Ref>& leaves,
               const PointOf& point_of) {
    const auto u = static_cast<std::size_t>(projection.u);
    const auto v = static_cast<std::size_t>(projection.v);
    const Vec<F>& origin = point_of(cells.tail(leaves.front()));
    F sum(0);
    for (const Ref leaf : leaves) {
        const Vec<F> a = minus<F>(point_of(cells.tail(leaf)), origin);
        const Vec<F> b = minus<F>(point_of(cells.head(leaf)), origin);
        sum += F(a[u] * b[v] - a[v] * b[u]);
    }
    return sum;
}

/// Six times the volume of the cone from `apex` over a face: height times area, both scaled by the
/// normal's largest component so that no root is taken.
template <class F, class PointOf>
F cone(const Cells& cells, const FaceSide& side, const Vec<F>& apex, std::vector<Ref>& leaves,
       const PointOf& point_of) {
    const Face& face = cells.face(side.face);
    cells.expand(face, leaves);
    const Projection projection = projection_of(cells, face.carrier);
    const auto axis = static_cast<std::size_t>(3 - projection.u - projection.v);
    const bool upward = projection.v == (projection.u + 1) % 3;
    const ExactPlane<F> plane = exact_plane<F>(cells, face.carrier);
    const Vec<F>& foot = point_of(cells.tail(leaves.front()));
    const F height = dot<F>(plane.normal, minus<F>(foot, apex));
    const F area = doubled_area<F>(cells, projection, leaves, point_of);
    const F six = F(height * area / plane.normal[axis]);
    return upward != side.flipped ? six : F(-six);
}

struct Approximation {
    double six_volumes = 0;
    double magnitude = 0;
};

Approximation approximate(const Cells& cells, const std::vector<FaceSide>& sides) {
    Approximation out;
    if (sides.empty()) {
        return out;
    }
    const auto point_of = [&](std::int32_t vertex) { return vec<double>(cells.point(vertex)); };
    std::vector<Ref> leaves;
    cells.expand(cells.face(sides.front().face), leaves);
    const Vec<double> apex = point_of(cells.tail(leaves.front()));
    double rest = 0;  // Neumaier's compensation
    for (const FaceSide& side : sides) {
        const auto term = cone<double>(cells, side, apex, leaves, point_of);
        const double total = out.six_volumes + term;
        rest += std::abs(out.six_volumes) >= std::abs(term) ? (out.six_volumes - total) + term
                                                            : (term - total) + out.six_volumes;
        out.six_volumes = total;
        out.magnitude += std::abs(term);
    }
    out.six_volumes += rest;
    return out;
}

/// Sums by halves, so that long numbers meet numbers of their own length.
Rational sum_of(const std::vector<Rational>& terms, std::size_t begin, std::size_t end) {
    if (end - begin == 1) {
        return terms[begin];
    }
    const std::size_t middle = begin + (end - begin) / 2;
    return sum_of(terms, begin, middle) + sum_of(terms, middle, end);
}

Rational exact_six_volumes(const Cells& cells, const std::vector<FaceSide>& sides) {
    if (sides.empty()) {
        return 0;
    }
    ExactPoints points(cells);
    const auto point_of = [&](std::int32_t vertex) -> const Vec<Rational>& {
        return points.of(vertex);
    };
    const Vec<Rational> apex{Rational(0), Rational(0), Rational(0)};
    std::vector<Ref> leaves;
    std::vector<Rational> terms;
    terms.reserve(sides.size());
    for (const FaceSide& side : sides) {
        terms.push_back(cone<Rational>(cells, side, apex, leaves, point_of));
    }
    return sum_of(terms, 0, terms.size());
}

}  // namespace

double approximate_volume(const Cells& cells, const std::vector<FaceSide>& sides) {
    return approximate(cells, sides).six_volumes / 6;
}

int volume_sign(const Cells& cells, const std::vector<FaceSide>& sides) {
    const Approximation a = approximate(cells, sides);
    if (std::abs(a.six_volumes) > kVolumeFilter * a.magnitude) {
        return a.six_volumes > 0 ? 1 : -1;
    }
    return sgn(exact_six_volumes(cells, sides));
}

std::string exact_volume(const Cells& cells, const std::vector<FaceSide>& sides) {
    Rational volume = exact_six_volumes(cells, sides) / 6;
    volume.canonicalize();
    return volume.get_num().get_str() + "/" + volume.get_den().get_str();
}

bool tiles_input_exactly(const Cells& cells) {
    const std::size_t count = cells.input->triangles.size();
    std::vector<std::int32_t> pieces(count, 0);
    for (const Face& face : cells.faces) {
        if (face.inside < 0 || (face.outside >= 0) != face.carrier.is_plane ||
            face.inside == face.outside) {
            return false;
        }
        if (!face.carrier.is_plane) {
            ++pieces[static_cast<std::size_t>(face.carrier.index)];
        }
    }
    ExactPoints points(cells);
    const auto point_of = [&](std::int32_t vertex) -> const Vec<Rational>& {
        return points.of(vertex);
    };
    std::vector<Rational> covered(count, 0);
    std::vector<Ref> leaves;
    for (const Face& face : cells.faces) {
        const auto triangle = static_cast<std::size_t>(face.carrier.index);
        if (!face.carrier.is_plane && pieces[triangle] > 1) {
            cells.expand(face, leaves);
            covered[triangle] +=
                doubled_area<Rational>(cells, projection_of(cells, face.carrier), leaves, point_of);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const mesh::Triangle& t = cells.input->triangles[i];
        if (pieces[i] == 0 && !is_flat(*cells.input, t)) {
            return false;
        }
        if (pieces[i] < 2) {
            continue;
        }
        const Projection p = projection_of(cells, {static_cast<std::int32_t>(i), false});
        const auto u = static_cast<std::size_t>(p.u);
        const auto v = static_cast<std::size_t>(p.v);
        const Vec<Rational> a = vec<Rational>(cells.input->points[t[0]]);
        const Vec<Rational> ab = minus<Rational>(vec<Rational>(cells.input->points[t[1]]), a);
        const Vec<Rational> ac = minus<Rational>(vec<Rational>(cells.input->points[t[2]]), a);
        if (covered[i] != Rational(ab[u] * ac[v] - ab[v] * ac[u])) {
            return false;
        }
    }
    return true;
}

}  // namespace decomp::cut
