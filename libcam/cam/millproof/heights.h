// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cam::millproof {

/// The nodes of a square lattice, row by row.
struct Nodes {
    Eigen::Vector2d origin = Eigen::Vector2d::Zero();
    double side = 0;
    int columns = 0;
    int rows = 0;

    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }

    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
};

/// Calls visit(node, z) for each node over or under a triangle that looks up.
template <class Visit>
void visit_nodes(const decomp::mesh::TriMesh& mesh, const decomp::mesh::Triangle& triangle,
                 const Nodes& nodes, const Visit& visit) {
    const Eigen::Vector3d& a = mesh.points[triangle[0]];
    const Eigen::Vector3d& b = mesh.points[triangle[1]];
    const Eigen::Vector3d& c = mesh.points[triangle[2]];
    const double area2 = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    if (!(area2 > 0)) {
        return;  // looks down, or stands upright
    }
    const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c);
    const Eigen::Vector3d high = a.cwiseMax(b).cwiseMax(c);
    const auto first = [&](int axis) {
        return std::max(0,
                        static_cast<int>(std::ceil((low[axis] - nodes.origin[axis]) / nodes.side)));
    };
    const auto x_of = [&](int column) { return nodes.origin.x() + column * nodes.side; };
    const auto y_of = [&](int row) { return nodes.origin.y() + row * nodes.side; };
    for (int row = first(1); row < nodes.rows && y_of(row) <= high.y(); ++row) {
        const double y = y_of(row);
        for (int column = first(0); column < nodes.columns && x_of(column) <= high.x(); ++column) {
            const double x = x_of(column);
            const double u = ((x - a.x()) * (c - a).y() - (y - a.y()) * (c - a).x()) / area2;
            const double v = ((b - a).x() * (y - a.y()) - (b - a).y() * (x - a.x())) / area2;
            if (u >= 0 && v >= 0 && u + v <= 1) {
                visit(nodes.index(column, row), a.z() + u * (b - a).z() + v * (c - a).z());
            }
        }
    }
}

}  // namespace cam::millproof
