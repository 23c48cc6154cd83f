// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/exact.h"

#include "decomp/cut/construct.h"

#include <Eigen/Geometry>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>

namespace decomp::cut {

namespace {

using Rational = mpq_class;

/// Nearest double; the truncated one when both are equally near.
double nearest_double(const Rational& value) {
    const double low = value.get_d();  // truncates toward zero
    const double next = std::nextafter(low, sgn(value) < 0 ? -HUGE_VAL : HUGE_VAL);
    const Rational twice = value * 2;
    const Rational middle = Rational(low) + Rational(next);
    return abs(twice) > abs(middle) ? next : low;
}

double& at(Eigen::Vector3d& p, int axis) { return p[axis]; }

}  // namespace

Eigen::Vector3d rounded_point(const Cells& cells, std::int32_t vertex) {
    const Vec<Rational> exact = exact_point<Rational>(cells, vertex);
    Eigen::Vector3d out;
    for (int k = 0; k < 3; ++k) {
        at(out, k) = nearest_double(exact[static_cast<std::size_t>(k)]);
    }
    return out;
}

int side_of_plane(const Cells& cells, std::int32_t vertex, const part::Plane& plane) {
    const Eigen::Vector3d& x = cells.point(vertex);
    const double u = plane.normal.x() * x.x();
    const double v = plane.normal.y() * x.y();
    const double w = plane.normal.z() * x.z();
    const double height = u + v + w - plane.offset_mm;
    // Half a unit in the last place of each coordinate and four roundings: below 1e-15 of the sum
    // of magnitudes.
    const double bound =
        2e-15 * (std::abs(u) + std::abs(v) + std::abs(w) + std::abs(plane.offset_mm));
    if (std::abs(height) > bound) {
        return height > 0 ? 1 : -1;
    }
    const Vec<Rational> point = exact_point<Rational>(cells, vertex);
    return sgn(Rational(dot<Rational>(vec<Rational>(plane.normal), point) - plane.offset_mm));
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
    const auto k = static_cast<std::size_t>(axis);
    return sgn(Rational(exact_point<Rational>(cells, a)[k] - exact_point<Rational>(cells, b)[k]));
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
    const double bound =
        2e-15 * (size * spread + std::abs(bu * cv) + std::abs(bv * cu)) + 1e-30 * size * size;
    if (area > bound) {
        return 1;
    }
    if (area < -bound) {
        return -1;
    }
    const Vec<Rational> ea = exact_point<Rational>(cells, a);
    const Vec<Rational> ab = minus<Rational>(exact_point<Rational>(cells, b), ea);
    const Vec<Rational> ac = minus<Rational>(exact_point<Rational>(cells, c), ea);
    const auto iu = static_cast<std::size_t>(u);
    const auto iv = static_cast<std::size_t>(v);
    return sgn(Rational(ab[iu] * ac[iv] - ab[iv] * ac[iu]));
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
        certain = normal.cwiseAbs().maxCoeff() >
                  1e-14 * ab.cwiseAbs().maxCoeff() * ac.cwiseAbs().maxCoeff();
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
    const Vec<Rational> a = exact_plane<Rational>(cells, carrier).normal;
    const Vec<Rational> b = exact_plane<Rational>(cells, {plane, true}).normal;
    return sgn(dot<Rational>(a, b));
}

bool is_flat(const mesh::TriMesh& mesh, const mesh::Triangle& triangle) {
    const Eigen::Vector3d ab = mesh.points[triangle[1]] - mesh.points[triangle[0]];
    const Eigen::Vector3d ac = mesh.points[triangle[2]] - mesh.points[triangle[0]];
    if (ab.cross(ac).cwiseAbs().maxCoeff() >
        1e-14 * ab.cwiseAbs().maxCoeff() * ac.cwiseAbs().maxCoeff()) {
        return false;
    }
    const Vec<Rational> a = vec<Rational>(mesh.points[triangle[0]]);
    const Vec<Rational> normal =
        cross<Rational>(minus<Rational>(vec<Rational>(mesh.points[triangle[1]]), a),
                        minus<Rational>(vec<Rational>(mesh.points[triangle[2]]), a));
    return sgn(normal[0]) == 0 && sgn(normal[1]) == 0 && sgn(normal[2]) == 0;
}

}  // namespace decomp::cut
