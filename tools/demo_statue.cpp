// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/demo_statue.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace tools {

namespace {

using decomp::mesh::TriMesh;
using Eigen::Vector3d;

/// Approximate signed distances, negative inside (after Inigo Quilez, "Distance functions").
double ellipsoid(const Vector3d& p, const Vector3d& centre, const Vector3d& radii) {
    const Vector3d q = (p - centre).cwiseQuotient(radii);
    const double gradient = q.cwiseQuotient(radii).norm();
    return gradient == 0 ? -radii.minCoeff() : q.norm() * (q.norm() - 1) / gradient;
}

double capsule(const Vector3d& p, const Vector3d& a, const Vector3d& b, double radius) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm() - radius;
}

/// The union of two shapes with a fillet of about `blend`.
double unite(double a, double b, double blend) {
    const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - h * h * blend / 4;
}

/// An upright cylinder with rounded rims.
double drum(const Vector3d& p, double bottom, double top, double radius) {
    constexpr double kRimMm = 8;
    const double side = std::hypot(p.x(), p.y()) - radius + kRimMm;
    const double height = std::abs(p.z() - (bottom + top) / 2) - (top - bottom) / 2 + kRimMm;
    return std::min(std::max(side, height), 0.0) +
           std::hypot(std::max(side, 0.0), std::max(height, 0.0)) - kRimMm;
}

double carve(double a, double b, double blend) { return -unite(-a, b, blend); }

/// The statue faces -y, towards a viewer at the front.
double statue(const Vector3d& seen) {
    const Vector3d p(-seen.x(), -seen.y(), seen.z());
    const Vector3d m(std::abs(p.x()), p.y(), p.z());  // what both sides have
    double head = ellipsoid(p, {0, 0, 338}, {56, 68, 78});
    head = unite(head, ellipsoid(p, {0, 22, 292}, {40, 42, 40}), 24);   // jaw
    head = unite(head, capsule(p, {0, 64, 340}, {0, 78, 316}, 8), 12);  // nose
    head = unite(head, ellipsoid(m, {24, 52, 352}, {20, 12, 6}), 8);    // brow
    head = carve(head, ellipsoid(m, {23, 68, 340}, {13, 10, 8}), 8);    // eye socket
    head = unite(head, ellipsoid(m, {23, 58, 339}, {9, 6, 6}), 3);      // eye
    head = unite(head, ellipsoid(p, {0, 60, 292}, {17, 8, 4.5}), 6);    // lips
    head = unite(head, ellipsoid(m, {57, -4, 330}, {8, 14, 20}), 6);    // ear
    const double wave = 3 * std::sin(p.z() / 7 + 2 * std::sin(p.x() / 19)) * std::cos(p.x() / 13);
    const double hair = ellipsoid(p, {0, -18, 352}, {64, 66, 72}) + wave;
    head = unite(head, std::max(hair, 0.55 * (p.y() - 26) - 0.83 * (p.z() - 366)), 6);
    double body = capsule(p, {0, -8, 214}, {0, -2, 292}, 34);               // neck
    body = unite(body, ellipsoid(p, {0, -6, 168}, {96, 56, 70}), 34);       // chest
    body = unite(body, ellipsoid(m, {86, -8, 180}, {44, 46, 44}), 30);      // shoulder
    body = unite(body, capsule(p, {-66, 30, 214}, {46, 36, 136}, 12), 14);  // sash
    body = -unite(-body, p.z() - 96, 12);
    double foot = drum(p, -5, 18, 88);
    foot = unite(foot, drum(p, 0, 76, 54 + 10 * std::cos(std::numbers::pi * p.z() / 70)), 10);
    foot = unite(foot, drum(p, 64, 118, 64), 16);
    return std::max(unite(unite(head, body, 16), foot, 14), -p.z());
}

/// What a corner exactly on the surface gets instead of 0, in cells.
constexpr double kOffSurface = 1e-9;

/// Where the surface crosses the edge from a (where the value is at_a) to b, by bisection; kept off
/// the ends so that no triangle becomes a sliver.
Vector3d crossing(const Vector3d& a, const Vector3d& b, double at_a) {
    constexpr int kHalvings = 20;
    constexpr double kLeast = 0.06;
    double low = 0;
    double high = 1;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = (low + high) / 2;
        const bool before = (statue(a + middle * (b - a)) < 0) == (at_a < 0);
        (before ? low : high) = middle;
    }
    return a + std::clamp((low + high) / 2, kLeast, 1 - kLeast) * (b - a);
}

/// A grid of cubes, each cut into six tetrahedra around its diagonal (Kuhn 1960), so that
/// neighbours share faces and the surface of {value < 0} is closed and manifold wherever no corner
/// is exactly 0.
class Sampler {
  public:
    Sampler(Vector3d low, double cell, std::array<int, 3> cells)
        : low_(std::move(low)), cell_(cell), cells_(cells) {
        for (int z = 0; z <= cells_[2]; ++z) {
            for (int y = 0; y <= cells_[1]; ++y) {
                for (int x = 0; x <= cells_[0]; ++x) {
                    const double value = statue(corner(x, y, z));
                    values_.push_back(value == 0 ? kOffSurface * cell_ : value);
                }
            }
        }
    }

    TriMesh surface() {
        for (int z = 0; z < cells_[2]; ++z) {
            for (int y = 0; y < cells_[1]; ++y) {
                for (int x = 0; x < cells_[0]; ++x) {
                    cube(x, y, z);
                }
            }
        }
        return std::move(mesh_);
    }

  private:
    using Corner = std::uint32_t;

    [[nodiscard]] Vector3d corner(int x, int y, int z) const {
        return low_ + cell_ * Vector3d(x, y, z);
    }

    [[nodiscard]] Corner index(int x, int y, int z) const {
        return static_cast<Corner>((z * (cells_[1] + 1) + y) * (cells_[0] + 1) + x);
    }

    [[nodiscard]] Vector3d position(Corner c) const {
        const int row = static_cast<int>(c) / (cells_[0] + 1);
        return corner(static_cast<int>(c) % (cells_[0] + 1), row % (cells_[1] + 1),
                      row / (cells_[1] + 1));
    }

    void cube(int x, int y, int z) {
        constexpr std::array<std::array<int, 3>, 6> kOrders{
            {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
        for (std::size_t k = 0; k < kOrders.size(); ++k) {
            std::array<int, 3> at{x, y, z};
            std::array<Corner, 4> tet{index(x, y, z)};
            for (std::size_t step = 0; step < 3; ++step) {
                ++at.at(static_cast<std::size_t>(kOrders[k][step]));
                tet[step + 1] = index(at[0], at[1], at[2]);
            }
            if (k >= 3) {
                std::swap(tet[2], tet[3]);  // odd permutations are mirrored
            }
            tetrahedron(tet);
        }
    }

    /// Orders the corners as inside ones first, by an even permutation, and adds the triangle or
    /// the quadrangle.
    void tetrahedron(std::array<Corner, 4> t) {
        constexpr std::array<std::array<std::size_t, 4>, 12> kEven{{{0, 1, 2, 3},
                                                                    {0, 2, 3, 1},
                                                                    {0, 3, 1, 2},
                                                                    {1, 0, 3, 2},
                                                                    {1, 2, 0, 3},
                                                                    {1, 3, 2, 0},
                                                                    {2, 0, 1, 3},
                                                                    {2, 1, 3, 0},
                                                                    {2, 3, 0, 1},
                                                                    {3, 0, 2, 1},
                                                                    {3, 1, 0, 2},
                                                                    {3, 2, 1, 0}}};
        const auto inside = [&](std::size_t i) { return values_[t.at(i)] < 0; };
        const long count =
            std::count_if(t.begin(), t.end(), [&](Corner c) { return values_[c] < 0; });
        if (count == 0 || count == 4) {
            return;
        }
        for (const auto& e : kEven) {
            const bool first = inside(e[0]);
            const bool second = inside(e[1]);
            const std::array<Corner, 4> c{t.at(e[0]), t.at(e[1]), t.at(e[2]), t.at(e[3])};
            if (count == 1 && first) {
                triangle(cut(c[0], c[1]), cut(c[0], c[2]), cut(c[0], c[3]));
                return;
            }
            if (count == 3 && !first) {
                triangle(cut(c[0], c[1]), cut(c[0], c[3]), cut(c[0], c[2]));
                return;
            }
            if (count == 2 && first && second) {
                triangle(cut(c[0], c[2]), cut(c[0], c[3]), cut(c[1], c[3]));
                triangle(cut(c[0], c[2]), cut(c[1], c[3]), cut(c[1], c[2]));
                return;
            }
        }
    }

    std::uint32_t cut(Corner a, Corner b) {
        if (a > b) {
            std::swap(a, b);
        }
        const auto [it, added] =
            cuts_.try_emplace({a, b}, static_cast<std::uint32_t>(mesh_.points.size()));
        if (added) {
            mesh_.points.push_back(crossing(position(a), position(b), values_[a]));
        }
        return it->second;
    }

    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh_.triangles.push_back({a, b, c});
    }

    Vector3d low_;
    double cell_;
    std::array<int, 3> cells_;
    std::vector<double> values_;
    std::map<std::pair<Corner, Corner>, std::uint32_t> cuts_;
    TriMesh mesh_;
};

}  // namespace

TriMesh demo_statue(double cell_mm) {
    const Vector3d low(-150, -110, -cell_mm);
    const Vector3d high(150, 110, 440);
    const Vector3d cells = ((high - low) / cell_mm).array().ceil();
    TriMesh mesh =
        Sampler(low, cell_mm, {int(cells.x()), int(cells.y()), int(cells.z())}).surface();
    double base = high.z();
    for (const Vector3d& point : mesh.points) {
        base = std::min(base, point.z());
    }
    for (Vector3d& point : mesh.points) {
        point.z() -= base;
    }
    return mesh;
}

}  // namespace tools
