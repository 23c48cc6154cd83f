// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/solid.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cam::millproof {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCellMm = 1;
/// Upright rays are shifted by these, mm: off the edges of meshes that lie on round numbers.
constexpr double kAsideX = 3.1e-7;
constexpr double kAsideY = 1.7e-7;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double distance_to_segment(const Vector3d& at, const Vector3d& a, const Vector3d& b) {
    const Vector3d way = b - a;
    const double length2 = way.squaredNorm();
    const double t = length2 > 0 ? std::clamp(way.dot(at - a) / length2, 0.0, 1.0) : 0.0;
    return (at - a - t * way).norm();
}

double distance_to_triangle(const Vector3d& at, const std::array<Vector3d, 3>& p) {
    const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const double area2 = normal.norm();
    bool over = area2 > 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3d& a = p[i];
        const Vector3d& b = p[(i + 1) % 3];
        over = over && (b - a).cross(at - a).dot(normal) >= 0;
        nearest = std::min(nearest, distance_to_segment(at, a, b));
    }
    return over ? std::abs((at - p[0]).dot(normal)) / area2 : nearest;
}

}  // namespace

Solid::Solid(const decomp::mesh::TriMesh& part) : part_(part) {
    Eigen::AlignedBox2d box;
    for (const Vector3d& p : part.points) {
        box.extend(Vector2d(p.head<2>()));
    }
    cells_.side = kCellMm;
    cells_.origin = box.min();
    cells_.columns = 1 + static_cast<int>(box.sizes().x() / kCellMm);
    cells_.rows = 1 + static_cast<int>(box.sizes().y() / kCellMm);
    triangles_.resize(cells_.count());
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
        Eigen::AlignedBox2d plan;
        for (const auto v : part.triangles[t]) {
            plan.extend(Vector2d(part.points[v].head<2>()));
        }
        for (int row = row_of(plan.min().y()); row <= row_of(plan.max().y()); ++row) {
            for (int column = column_of(plan.min().x()); column <= column_of(plan.max().x());
                 ++column) {
                triangles_[cells_.index(column, row)].push_back(static_cast<std::uint32_t>(t));
            }
        }
    }
}

int Solid::column_of(double x) const {
    return static_cast<int>(
        std::clamp(std::floor((x - cells_.origin.x()) / kCellMm), 0.0, cells_.columns - 1.0));
}

int Solid::row_of(double y) const {
    return static_cast<int>(
        std::clamp(std::floor((y - cells_.origin.y()) / kCellMm), 0.0, cells_.rows - 1.0));
}

bool Solid::holds(const Vector3d& at) const {
    const Vector2d q(at.x() + kAsideX, at.y() + kAsideY);
    int above = 0;
    for (const std::uint32_t t : triangles_[cells_.index(column_of(q.x()), row_of(q.y()))]) {
        std::array<Vector2d, 3> p;
        std::array<double, 3> z{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector3d& corner = part_.points[part_.triangles[t][i]];
            p[i] = corner.head<2>() - q;
            z[i] = corner.z();
        }
        const double u = cross(p[1], p[2]);
        const double v = cross(p[2], p[0]);
        const double w = cross(p[0], p[1]);
        const bool looks_up = u >= 0 && v >= 0 && w >= 0;
        const bool looks_down = u <= 0 && v <= 0 && w <= 0;
        const double area2 = u + v + w;
        if (looks_up == looks_down || (u * z[0] + v * z[1] + w * z[2]) / area2 <= at.z()) {
            continue;
        }
        above += looks_up ? 1 : -1;
    }
    return above > 0;
}

double Solid::nearest_over(std::size_t cell, const Vector3d& at) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : triangles_[cell]) {
        const decomp::mesh::Triangle& corners = part_.triangles[t];
        nearest = std::min(
            nearest, distance_to_triangle(at, {part_.points[corners[0]], part_.points[corners[1]],
                                               part_.points[corners[2]]}));
    }
    return nearest;
}

double Solid::depth(const Vector3d& at, double limit) const {
    if (!holds(at)) {
        return 0;
    }
    double nearest = limit;
    for (int row = row_of(at.y() - limit); row <= row_of(at.y() + limit); ++row) {
        for (int column = column_of(at.x() - limit); column <= column_of(at.x() + limit);
             ++column) {
            nearest = std::min(nearest, nearest_over(cells_.index(column, row), at));
        }
    }
    return nearest;
}

}  // namespace cam::millproof
