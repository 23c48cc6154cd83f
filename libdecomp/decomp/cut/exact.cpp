// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/exact.h"

#include "decomp/cut/ball.h"
#include "decomp/cut/construct.h"

#include <Eigen/Geometry>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace decomp::cut {

namespace {

using Rational = mpq_class;

/// Bounds of the double filters, relative to the magnitudes that enter. A coordinate is off by half
/// a unit in the last place (1.1e-16); the expressions below add at most a dozen roundings.
constexpr double kFilter = 4e-15;
constexpr double kCircleFilter = 6e-14;
constexpr double kSquaredRounding = 1e-30;
/// Below this sine of its angle the direction of a triangle's normal is taken exactly.
constexpr double kFlatSine = 1e-14;

/// Sign of an expression over a field, first as a ball, then as a fraction.
template <class Expression>
int sign_of(const Expression& expression) {
    const int sign = expression(std::type_identity<Ball>{}).sign();
    return sign != 0 ? sign : sgn(expression(std::type_identity<Rational>{}));
}

/// Nearest double; the truncated one when both are equally near.
double nearest_double(const Rational& value) {
    const double low = value.get_d();  // truncates toward zero
    const double next = std::nextafter(low, sgn(value) < 0 ? -HUGE_VAL : HUGE_VAL);
    const Rational twice = value * 2;
    const Rational middle = Rational(low) + Rational(next);
    return abs(twice) > abs(middle) ? next : low;
}

template <class F>
using Flat = std::array<F, 2>;

template <class F>
Flat<F> flat_point(const Cells& cells, Projection projection, std::int32_t vertex) {
    const Vec<F> p = exact_point<F>(cells, vertex);
    return {p[static_cast<std::size_t>(projection.u)], p[static_cast<std::size_t>(projection.v)]};
}

template <class F>
Flat<F> flat_minus(const Flat<F>& a, const Flat<F>& b) {
    return {F(a[0] - b[0]), F(a[1] - b[1])};
}

/// Positive when the origin lies inside the circle through three points given counter-clockwise.
template <class F>
F circle_determinant(const std::array<Flat<F>, 3>& p) {
    F sum(0);
    for (std::size_t i = 0; i < 3; ++i) {
        const Flat<F>& a = p.at(i);
        const Flat<F>& b = p.at((i + 1) % 3);
        const Flat<F>& c = p.at((i + 2) % 3);
        sum += F(F(a[0] * a[0] + a[1] * a[1]) * F(b[0] * c[1] - b[1] * c[0]));
    }
    return sum;
}

bool is_clearly_turned(const Eigen::Vector3d& normal, const Eigen::Vector3d& a,
                       const Eigen::Vector3d& b) {
    return normal.cwiseAbs().maxCoeff() >
           kFlatSine * a.cwiseAbs().maxCoeff() * b.cwiseAbs().maxCoeff();
}

}  // namespace

Eigen::Vector3d rounded_point(const Cells& cells, std::int32_t vertex) {
    const Vec<Ball> near = exact_point<Ball>(cells, vertex);
    if (near[0].rounds_to_high() && near[1].rounds_to_high() && near[2].rounds_to_high()) {
        return {near[0].high(), near[1].high(), near[2].high()};
    }
    const Vec<Rational> exact = exact_point<Rational>(cells, vertex);
    return {nearest_double(exact[0]), nearest_double(exact[1]), nearest_double(exact[2])};
}

int side_of_plane(const Cells& cells, std::int32_t vertex, const part::Plane& plane) {
    const Eigen::Vector3d& x = cells.point(vertex);
    const double u = plane.normal.x() * x.x();
    const double v = plane.normal.y() * x.y();
    const double w = plane.normal.z() * x.z();
    const double height = u + v + w - plane.offset_mm;
    const double bound =
        kFilter * (std::abs(u) + std::abs(v) + std::abs(w) + std::abs(plane.offset_mm));
    if (std::abs(height) > bound) {
        return height > 0 ? 1 : -1;
    }
    return sign_of([&]<class F>(std::type_identity<F>) {
        return F(dot<F>(vec<F>(plane.normal), exact_point<F>(cells, vertex)) - F(plane.offset_mm));
    });
}

int side_of_plane(const Cells& cells, std::int32_t vertex, std::int32_t plane) {
    if (!cells.is_input(vertex)) {
        const VertexSource& s = cells.source(vertex);
        const bool b_is_plane = s.kind != VertexSource::Kind::EdgePlane;
        const bool a_is_plane = s.kind == VertexSource::Kind::ThreePlanes;
        if (s.c == plane || (b_is_plane && s.b == plane) || (a_is_plane && s.a == plane)) {
            return 0;
        }
    }
    return side_of_plane(cells, vertex, cells.planes[static_cast<std::size_t>(plane)]);
}

int compare_coordinate(const Cells& cells, std::int32_t a, std::int32_t b, int axis) {
    const double low = cells.point(a)[axis];
    const double high = cells.point(b)[axis];
    if (low != high) {  // rounding to nearest never changes an order
        return low < high ? -1 : 1;
    }
    if (a == b || (cells.is_input(a) && cells.is_input(b))) {
        return 0;
    }
    return sign_of([&]<class F>(std::type_identity<F>) {
        const auto k = static_cast<std::size_t>(axis);
        return F(exact_point<F>(cells, a)[k] - exact_point<F>(cells, b)[k]);
    });
}

bool lexicographically_less(const Cells& cells, std::int32_t a, std::int32_t b) {
    for (int axis = 0; axis < 3; ++axis) {
        const int order = compare_coordinate(cells, a, b, axis);
        if (order != 0) {
            return order < 0;
        }
    }
    return false;
}

int turn(const Cells& cells, Projection projection, std::int32_t a, std::int32_t b,
         std::int32_t c) {
    if (a == b || b == c || c == a) {
        return 0;
    }
    const int u = projection.u;
    const int v = projection.v;
    const Eigen::Vector3d& pa = cells.point(a);
    const Eigen::Vector3d& pb = cells.point(b);
    const Eigen::Vector3d& pc = cells.point(c);
    const double bu = pb[u] - pa[u];
    const double bv = pb[v] - pa[v];
    const double cu = pc[u] - pa[u];
    const double cv = pc[v] - pa[v];
    const double area = bu * cv - bv * cu;
    const double size = std::max({std::abs(pa[u]), std::abs(pa[v]), std::abs(pb[u]),
                                  std::abs(pb[v]), std::abs(pc[u]), std::abs(pc[v])});
    const double spread = std::abs(bu) + std::abs(bv) + std::abs(cu) + std::abs(cv);
    const double bound = kFilter * (size * spread + std::abs(bu * cv) + std::abs(bv * cu)) +
                         kSquaredRounding * size * size;
    if (std::abs(area) > bound) {
        return area > 0 ? 1 : -1;
    }
    return sign_of([&]<class F>(std::type_identity<F>) {
        const Flat<F> o = flat_point<F>(cells, projection, a);
        const Flat<F> p = flat_minus<F>(flat_point<F>(cells, projection, b), o);
        const Flat<F> q = flat_minus<F>(flat_point<F>(cells, projection, c), o);
        return F(p[0] * q[1] - p[1] * q[0]);
    });
}

int in_circle(const Cells& cells, Projection projection, const std::array<std::int32_t, 4>& v) {
    const Eigen::Vector3d& origin = cells.point(v[3]);
    std::array<Flat<double>, 3> d{};
    double spread = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3d& p = cells.point(v.at(i));
        d.at(i) = {p[projection.u] - origin[projection.u], p[projection.v] - origin[projection.v]};
        spread = std::max({spread, std::abs(d.at(i)[0]), std::abs(d.at(i)[1])});
    }
    const double size =
        spread + std::max(std::abs(origin[projection.u]), std::abs(origin[projection.v]));
    const auto near = circle_determinant<double>(d);
    if (std::abs(near) > kCircleFilter * size * spread * spread * spread) {
        return near > 0 ? 1 : -1;
    }
    return sign_of([&]<class F>(std::type_identity<F>) {
        const Flat<F> o = flat_point<F>(cells, projection, v[3]);
        std::array<Flat<F>, 3> e;
        for (std::size_t i = 0; i < 3; ++i) {
            e.at(i) = flat_minus<F>(flat_point<F>(cells, projection, v.at(i)), o);
        }
        return circle_determinant<F>(e);
    });
}

Projection projection_of(const Cells& cells, Carrier carrier) {
    Eigen::Vector3d normal;
    bool certain = true;
    if (carrier.is_plane) {
        normal = cells.planes[static_cast<std::size_t>(carrier.index)].normal;
    } else {
        const mesh::Triangle& t = cells.input->triangles[static_cast<std::size_t>(carrier.index)];
        const Eigen::Vector3d ab = cells.input->points[t[1]] - cells.input->points[t[0]];
        const Eigen::Vector3d ac = cells.input->points[t[2]] - cells.input->points[t[0]];
        normal = ab.cross(ac);
        certain = is_clearly_turned(normal, ab, ac);
    }
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    bool upward = normal[axis] > 0;
    if (!certain) {
        const Vec<Rational> exact = exact_plane<Rational>(cells, carrier).normal;
        std::size_t k = 0;
        for (std::size_t i = 1; i < 3; ++i) {
            k = abs(exact[i]) > abs(exact[k]) ? i : k;
        }
        axis = static_cast<Eigen::Index>(k);
        upward = sgn(exact[k]) > 0;
    }
    const int first = static_cast<int>((axis + 1) % 3);
    const int second = static_cast<int>((axis + 2) % 3);
    return upward ? Projection{first, second} : Projection{second, first};
}

int compare_directions(const Cells& cells, Carrier carrier, std::int32_t plane) {
    return sign_of([&]<class F>(std::type_identity<F>) {
        return dot<F>(exact_plane<F>(cells, carrier).normal,
                      exact_plane<F>(cells, {plane, true}).normal);
    });
}

bool is_flat(const mesh::TriMesh& mesh, const mesh::Triangle& triangle) {
    const Eigen::Vector3d ab = mesh.points[triangle[1]] - mesh.points[triangle[0]];
    const Eigen::Vector3d ac = mesh.points[triangle[2]] - mesh.points[triangle[0]];
    if (is_clearly_turned(ab.cross(ac), ab, ac)) {
        return false;
    }
    const Vec<Rational> a = vec<Rational>(mesh.points[triangle[0]]);
    const Vec<Rational> normal =
        cross<Rational>(minus<Rational>(vec<Rational>(mesh.points[triangle[1]]), a),
                        minus<Rational>(vec<Rational>(mesh.points[triangle[2]]), a));
    return sgn(normal[0]) == 0 && sgn(normal[1]) == 0 && sgn(normal[2]) == 0;
}

}  // namespace decomp::cut
