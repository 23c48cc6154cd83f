// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/polycube/exact_detail.h"

#include <gmpxx.h>

#include <array>
#include <cmath>

namespace decomp::polycube {

namespace {

// Generous bounds of the rounding of the products below, relative to their permanents.
constexpr double kVolumeBound = 1e-14;
constexpr double kAreaBound = 1e-14;

using Rational = std::array<mpq_class, 3>;

Rational difference(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return {mpq_class(p.x()) - mpq_class(q.x()), mpq_class(p.y()) - mpq_class(q.y()),
            mpq_class(p.z()) - mpq_class(q.z())};
}

}  // namespace

int volume_sign(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d) {
    const Eigen::Vector3d u = b - a;
    const Eigen::Vector3d v = c - a;
    const Eigen::Vector3d w = d - a;
    const double det = u.x() * (v.y() * w.z() - v.z() * w.y()) -
                       u.y() * (v.x() * w.z() - v.z() * w.x()) +
                       u.z() * (v.x() * w.y() - v.y() * w.x());
    const Eigen::Array3d au = u.array().abs();
    const Eigen::Array3d av = v.array().abs();
    const Eigen::Array3d aw = w.array().abs();
    const double size = au.x() * (av.y() * aw.z() + av.z() * aw.y()) +
                        au.y() * (av.x() * aw.z() + av.z() * aw.x()) +
                        au.z() * (av.x() * aw.y() + av.y() * aw.x());
    if (std::abs(det) > kVolumeBound * size) {
        return det > 0 ? 1 : -1;
    }
    const Rational p = difference(b, a);
    const Rational q = difference(c, a);
    const Rational r = difference(d, a);
    const mpq_class exact = p[0] * (q[1] * r[2] - q[2] * r[1]) -
                            p[1] * (q[0] * r[2] - q[2] * r[0]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
    return sgn(exact);
}

int area_sign(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
              int axis) {
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    const double left = (b[i] - a[i]) * (c[j] - a[j]);
    const double right = (b[j] - a[j]) * (c[i] - a[i]);
    if (std::abs(left - right) > kAreaBound * (std::abs(left) + std::abs(right))) {
        return left > right ? 1 : -1;
    }
    const mpq_class exact = (mpq_class(b[i]) - a[i]) * (mpq_class(c[j]) - a[j]) -
                            (mpq_class(b[j]) - a[j]) * (mpq_class(c[i]) - a[i]);
    return sgn(exact);
}

}  // namespace decomp::polycube
