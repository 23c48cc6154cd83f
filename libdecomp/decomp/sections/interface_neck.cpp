// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sections/interface_neck.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

namespace decomp::sections {

namespace {

constexpr double kWithin = 0.01;        // of the diameter
constexpr int kMostSquares = 20000;     // looked at for one piece
constexpr double kLeastSquares = 16.0;  // along the longer side, to begin with

using Point = Eigen::Vector2d;
using Segment = std::pair<Point, Point>;

/// Positive within the rim, by parity; the distance to it in either case.
double signed_distance(const std::vector<Segment>& rim, const Point& point) {
    double least = std::numeric_limits<double>::infinity();
    bool inside = false;
    for (const auto& [a, b] : rim) {
        const Point along = b - a;
        const double length2 = along.squaredNorm();
        const double t = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
        least = std::min(least, (point - a - t * along).squaredNorm());
        if ((a.y() > point.y()) != (b.y() > point.y()) &&
            point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * along.x()) {
            inside = !inside;
        }
    }
    return inside ? std::sqrt(least) : -std::sqrt(least);
}

struct Square {
    Point centre;
    double half = 0;
    double distance = 0;

    /// No point of the square is farther within than this.
    [[nodiscard]] double bound() const { return distance + half * std::sqrt(2.0); }

    bool operator<(const Square& other) const { return bound() < other.bound(); }
};

/// Radius of the largest circle within a rim: squares that may hold its centre are quartered,
/// the most promising first.
double inner_radius(const std::vector<Segment>& rim) {
    Eigen::AlignedBox2d box;
    for (const auto& [a, b] : rim) {
        box.extend(a);
        box.extend(b);
    }
    const double half = box.sizes().maxCoeff() / kLeastSquares / 2;
    if (!(half > 0)) {
        return 0;
    }
    std::priority_queue<Square> open;
    double best = 0;
    int looked = 0;
    const auto look = [&](const Point& centre, double size) {
        const Square square{centre, size, signed_distance(rim, centre)};
        best = std::max(best, square.distance);
        ++looked;
        if (square.bound() > best * (1 + kWithin)) {
            open.push(square);
        }
    };
    for (double x = box.min().x() + half; x - half < box.max().x(); x += 2 * half) {
        for (double y = box.min().y() + half; y - half < box.max().y(); y += 2 * half) {
            look({x, y}, half);
        }
    }
    while (!open.empty() && looked < kMostSquares) {
        const Square square = open.top();
        open.pop();
        if (square.bound() <= best * (1 + kWithin)) {
            break;
        }
        const double quarter = square.half / 2;
        for (const double x : {-quarter, quarter}) {
            for (const double y : {-quarter, quarter}) {
                look(square.centre + Point(x, y), quarter);
            }
        }
    }
    return best;
}

/// Two axes within the plane.
Eigen::Matrix<double, 2, 3> axes_within(const part::Plane& plane) {
    const Eigen::Vector3d normal = plane.normal.normalized();
    Eigen::Matrix<double, 2, 3> out;
    out.row(0) = normal.unitOrthogonal().transpose();
    out.row(1) = normal.cross(out.row(0).transpose()).transpose();
    return out;
}

/// For each facet the first that it hangs together with by edges.
std::vector<std::size_t> pieces_of(const std::vector<mesh::Triangle>& facets) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> owner;
    std::vector<std::size_t> piece(facets.size());
    std::iota(piece.begin(), piece.end(), 0U);
    const auto root = [&](std::size_t i) {
        while (piece[i] != i) {
            i = piece[i];
        }
        return i;
    };
    for (std::size_t i = 0; i < facets.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto edge = std::minmax(facets[i].at(k), facets[i].at((k + 1) % 3));
            const auto [found, fresh] = owner.emplace(edge, i);
            if (!fresh) {
                const std::size_t a = root(found->second);
                const std::size_t b = root(i);
                piece[std::max(a, b)] = std::min(a, b);
            }
        }
    }
    for (std::size_t i = 0; i < piece.size(); ++i) {
        piece[i] = root(i);
    }
    return piece;
}

}  // namespace

double interface_neck_mm(const part::Assembly& assembly, const part::Interface& interface) {
    const part::Part& part = assembly.parts[static_cast<std::size_t>(interface.part_a)];
    std::vector<mesh::Triangle> facets;
    for (std::size_t i = 0; i < part.sources.size(); ++i) {
        if (part.sources[i].plane == interface.plane &&
            part.sources[i].neighbour == interface.part_b) {
            facets.push_back(part.mesh.triangles[i]);
        }
    }
    const auto axes = axes_within(assembly.planes[static_cast<std::size_t>(interface.plane)]);
    const std::vector<std::size_t> piece = pieces_of(facets);
    // Edges of one facet alone are the rim.
    std::map<std::size_t, std::map<std::pair<std::uint32_t, std::uint32_t>, int>> uses;
    for (std::size_t i = 0; i < facets.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++uses[piece[i]][std::minmax(facets[i].at(k), facets[i].at((k + 1) % 3))];
        }
    }
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [first, edges] : uses) {
        std::vector<Segment> rim;
        for (const auto& [edge, count] : edges) {
            if (count == 1) {
                rim.emplace_back(axes * part.mesh.points[edge.first],
                                 axes * part.mesh.points[edge.second]);
            }
        }
        least = std::min(least, rim.empty() ? 0 : 2 * inner_radius(rim));
    }
    return std::isfinite(least) ? least : 0;
}

}  // namespace decomp::sections
