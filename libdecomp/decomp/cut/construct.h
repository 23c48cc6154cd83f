// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cut/cells.h"

#include <array>

/// Exact constructions over any field F that a double converts to without loss.
namespace decomp::cut {

template <class F>
using Vec = std::array<F, 3>;

template <class F>
Vec<F> vec(const Eigen::Vector3d& p) {
    return {F(p.x()), F(p.y()), F(p.z())};
}

template <class F>
Vec<F> minus(const Vec<F>& a, const Vec<F>& b) {
    return {F(a[0] - b[0]), F(a[1] - b[1]), F(a[2] - b[2])};
}

template <class F>
F dot(const Vec<F>& a, const Vec<F>& b) {
    return F(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

template <class F>
Vec<F> cross(const Vec<F>& a, const Vec<F>& b) {
    return {F(a[1] * b[2] - a[2] * b[1]), F(a[2] * b[0] - a[0] * b[2]),
            F(a[0] * b[1] - a[1] * b[0])};
}

/// normal . x = offset.
template <class F>
struct ExactPlane {
    Vec<F> normal;
    F offset;
};

template <class F>
ExactPlane<F> exact_plane(const Cells& cells, Carrier carrier) {
    if (carrier.is_plane) {
        const part::Plane& plane = cells.planes[static_cast<std::size_t>(carrier.index)];
        return {vec<F>(plane.normal), F(plane.offset_mm)};
    }
    const mesh::Triangle& t = cells.input->triangles[static_cast<std::size_t>(carrier.index)];
    const Vec<F> a = vec<F>(cells.input->points[t[0]]);
    const Vec<F> b = vec<F>(cells.input->points[t[1]]);
    const Vec<F> c = vec<F>(cells.input->points[t[2]]);
    const Vec<F> normal = cross<F>(minus<F>(b, a), minus<F>(c, a));
    return {normal, dot<F>(normal, a)};
}

/// The point common to three planes (Cramer's rule).
template <class F>
Vec<F> common_point(const ExactPlane<F>& p, const ExactPlane<F>& q, const ExactPlane<F>& r) {
    const Vec<F> qr = cross<F>(q.normal, r.normal);
    const Vec<F> rp = cross<F>(r.normal, p.normal);
    const Vec<F> pq = cross<F>(p.normal, q.normal);
    const F whole = dot<F>(p.normal, qr);
    Vec<F> out;
    for (std::size_t k = 0; k < 3; ++k) {
        out[k] = F((p.offset * qr[k] + q.offset * rp[k] + r.offset * pq[k]) / whole);
    }
    return out;
}

/// Exact coordinates of a vertex.
template <class F>
Vec<F> exact_point(const Cells& cells, std::int32_t vertex) {
    if (cells.is_input(vertex)) {
        return vec<F>(cells.point(vertex));
    }
    const VertexSource& s = cells.source(vertex);
    switch (s.kind) {
        case VertexSource::Kind::FacetTwoPlanes:
        case VertexSource::Kind::ThreePlanes:
            return common_point<F>(
                exact_plane<F>(cells, {s.a, s.kind == VertexSource::Kind::ThreePlanes}),
                exact_plane<F>(cells, {s.b, true}), exact_plane<F>(cells, {s.c, true}));
        case VertexSource::Kind::EdgePlane:
            break;
    }
    const Vec<F> a = vec<F>(cells.point(s.a));
    const Vec<F> b = vec<F>(cells.point(s.b));
    const ExactPlane<F> plane = exact_plane<F>(cells, {s.c, true});
    const F height_a = F(dot<F>(plane.normal, a) - plane.offset);
    const F height_b = F(dot<F>(plane.normal, b) - plane.offset);
    const F whole = F(height_b - height_a);
    Vec<F> out;
    for (std::size_t k = 0; k < 3; ++k) {
        out[k] = F((a[k] * height_b - b[k] * height_a) / whole);
    }
    return out;
}

}  // namespace decomp::cut
