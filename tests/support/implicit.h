// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

/// Shapes of any genus, as the inside of a function, and their surfaces.
namespace tests {

/// Below 0 inside; about the distance to the surface near it.
using Field = std::function<double(const Eigen::Vector3d&)>;

/// The surface on which the field is 0, outward oriented, closed and manifold, by marching
/// tetrahedra on a grid of cubes of the given size. The field must be above 0 on the border of the
/// box.
inline decomp::mesh::TriMesh surface_of(const Field& field, const Eigen::Vector3d& low,
                                        const Eigen::Vector3d& high, double cube) {
    constexpr double kLeastShare = 0.1;  // points keep off the grid's corners: no slivers
    const Eigen::Vector3i n = ((high - low) / cube).array().ceil().cast<int>() + 1;
    const auto at = [&](int x, int y, int z) {
        return static_cast<std::uint32_t>((z * n.y() + y) * n.x() + x);
    };
    const auto place = [&](std::uint32_t i) {
        const int x = static_cast<int>(i) % n.x();
        const int y = static_cast<int>(i) / n.x() % n.y();
        const int z = static_cast<int>(i) / n.x() / n.y();
        return Eigen::Vector3d(low + cube * Eigen::Vector3d(x, y, z));
    };
    std::vector<double> value(static_cast<std::size_t>(n.x()) * static_cast<std::size_t>(n.y()) *
                              static_cast<std::size_t>(n.z()));
    for (std::uint32_t i = 0; i < value.size(); ++i) {
        value[i] = field(place(i));
    }
    decomp::mesh::TriMesh out;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> on_edge;
    const auto crossing = [&](std::uint32_t a, std::uint32_t b) {
        const auto key = std::minmax(a, b);
        const auto [found, is_new] =
            on_edge.emplace(key, static_cast<std::uint32_t>(out.points.size()));
        if (is_new) {
            const double share =
                std::clamp(value[key.first] / (value[key.first] - value[key.second]), kLeastShare,
                           1 - kLeastShare);
            out.points.push_back((1 - share) * place(key.first) + share * place(key.second));
        }
        return found->second;
    };
    // Six tetrahedra around the diagonal of each cube; the faces of neighbouring cubes agree.
    constexpr std::array<std::array<int, 3>, 6> kOrders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, bool turn) {
        out.triangles.push_back(turn ? decomp::mesh::Triangle{a, c, b}
                                     : decomp::mesh::Triangle{a, b, c});
    };
    for (int z = 0; z + 1 < n.z(); ++z) {
        for (int y = 0; y + 1 < n.y(); ++y) {
            for (int x = 0; x + 1 < n.x(); ++x) {
                for (std::size_t o = 0; o < kOrders.size(); ++o) {
                    Eigen::Vector3i corner(x, y, z);
                    std::array<std::uint32_t, 4> tet{at(x, y, z), 0, 0, 0};
                    for (std::size_t k = 0; k < 3; ++k) {
                        corner[kOrders.at(o).at(k)] += 1;
                        tet.at(k + 1) = at(corner.x(), corner.y(), corner.z());
                    }
                    if (o >= 3) {
                        std::swap(tet[2], tet[3]);  // all six positively oriented
                    }
                    std::vector<std::size_t> in;
                    std::vector<std::size_t> off;
                    for (std::size_t k = 0; k < 4; ++k) {
                        (value[tet.at(k)] < 0 ? in : off).push_back(k);
                    }
                    if (in.empty() || off.empty()) {
                        continue;
                    }
                    std::array<std::size_t, 4> order{};
                    std::copy(in.begin(), in.end(), order.begin());
                    std::copy(off.begin(), off.end(),
                              order.begin() + static_cast<std::ptrdiff_t>(in.size()));
                    int swaps = 0;
                    for (std::size_t i = 0; i < 4; ++i) {
                        for (std::size_t j = i + 1; j < 4; ++j) {
                            swaps += order.at(i) > order.at(j) ? 1 : 0;
                        }
                    }
                    const bool odd = swaps % 2 == 1;
                    const auto cut = [&](std::size_t i, std::size_t j) {
                        return crossing(tet.at(order.at(i)), tet.at(order.at(j)));
                    };
                    if (in.size() == 1) {
                        triangle(cut(0, 1), cut(0, 2), cut(0, 3), odd);
                    } else if (in.size() == 3) {
                        triangle(cut(3, 0), cut(3, 1), cut(3, 2), odd);
                    } else {
                        triangle(cut(0, 2), cut(0, 3), cut(1, 3), odd);
                        triangle(cut(0, 2), cut(1, 3), cut(1, 2), odd);
                    }
                }
            }
        }
    }
    return out;
}

/// Union whose crease is rounded within about `blend`.
inline double blended(double a, double b, double blend) {
    const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - h * h * blend / 4;
}

inline double capsule_field(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b, double radius) {
    const Eigen::Vector3d along = b - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - a - t * along).norm() - radius;
}

/// A torus about an axis of unit length.
inline double torus_field(const Eigen::Vector3d& p, const Eigen::Vector3d& centre,
                          const Eigen::Vector3d& axis, double radius, double tube) {
    const Eigen::Vector3d q = p - centre;
    const double height = q.dot(axis);
    const double out = (q - height * axis).norm() - radius;
    return std::hypot(out, height) - tube;
}

/// An upright cylinder about Z with its edges rounded.
inline double cylinder_field(const Eigen::Vector3d& p, double radius, double low, double high,
                             double rounding) {
    const double out = std::hypot(p.x(), p.y()) - radius + rounding;
    const double beyond = std::max(low - p.z(), p.z() - high) + rounding;
    return std::hypot(std::max(out, 0.0), std::max(beyond, 0.0)) +
           std::min(std::max(out, beyond), 0.0) - rounding;
}

}  // namespace tests
