// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/part/part.h"
#include "tests/support/shapes.h"

#include <vector>

/// Shapes whose makeability has a closed form.
namespace tests {

/// A mesh as a part that was never cut.
inline decomp::part::Part whole(const TriMesh& mesh) {
    decomp::part::Part part;
    part.id = "P01";
    part.mesh = mesh;
    part.sources.resize(mesh.triangles.size());
    return part;
}

/// The upper half of a ball, its flat at z = 0.
inline TriMesh half_sphere(double radius, std::uint32_t around, std::uint32_t rings) {
    std::vector<std::array<double, 2>> profile;
    for (std::uint32_t i = 1; i <= rings; ++i) {
        const double polar = std::numbers::pi / 2 * i / rings;
        profile.push_back({radius * std::sin(polar), i == rings ? 0 : radius * std::cos(polar)});
    }
    return revolved(radius, profile, 0, around);
}

/// Points (x, y, z) become (z, x, y): what stood along Z lies along X.
inline TriMesh lying_along_x(TriMesh mesh) {
    for (auto& point : mesh.points) {
        point = Eigen::Vector3d(point.z(), point.x(), point.y());
    }
    return mesh;
}

/// A cylinder along X, between x = 0 and x = length, its axis on the X axis.
inline TriMesh cylinder_x(double radius, double length, std::uint32_t around) {
    return lying_along_x(revolved(length, {{radius, length}, {radius, 0}}, 0, around));
}

/// A prism over a simple polygon (counter-clockwise in X, Z), between y = 0 and y = depth. The
/// polygon is cut into triangles by ears.
inline TriMesh prism(const std::vector<Eigen::Vector2d>& outline, double depth) {
    TriMesh mesh;
    const auto count = static_cast<std::uint32_t>(outline.size());
    for (const double y : {0.0, depth}) {
        for (const auto& p : outline) {
            mesh.points.emplace_back(p.x(), y, p.y());
        }
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t j = (i + 1) % count;
        mesh.triangles.push_back({i, i + count, j});
        mesh.triangles.push_back({j, i + count, j + count});
    }
    std::vector<std::uint32_t> left(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        left[i] = i;
    }
    const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Eigen::Vector2d u = outline[b] - outline[a];
        const Eigen::Vector2d v = outline[c] - outline[a];
        return u.x() * v.y() - u.y() * v.x();
    };
    while (left.size() > 2) {
        for (std::size_t i = 0; i < left.size(); ++i) {
            const std::uint32_t a = left[(i + left.size() - 1) % left.size()];
            const std::uint32_t b = left[i];
            const std::uint32_t c = left[(i + 1) % left.size()];
            const bool ear =
                turn(a, b, c) > 0 && std::none_of(left.begin(), left.end(), [&](std::uint32_t p) {
                    return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
                           turn(c, a, p) >= 0;
                });
            if (ear) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({a + count, c + count, b + count});
                left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
                break;
            }
        }
    }
    return mesh;
}

/// An L: a foot of length x `side` and a leg `side` wide up to `side + rise`; depth `side`.
inline TriMesh el(double length, double side, double rise) {
    return prism(
        {{0, 0}, {length, 0}, {length, side}, {side, side}, {side, side + rise}, {0, side + rise}},
        side);
}

/// Two legs and a lintel: an opening `span` wide and `rise` high, everything else `side` thick.
inline TriMesh portal(double span, double side, double rise, double lintel) {
    const double width = span + 2 * side;
    return prism({{0, 0},
                  {side, 0},
                  {side, rise},
                  {side + span, rise},
                  {side + span, 0},
                  {width, 0},
                  {width, rise + lintel},
                  {0, rise + lintel}},
                 side);
}

/// A stem with an arm at its top, at the end of which a tip hangs down by `tip`.
inline TriMesh hook(double side, double height, double tip) {
    return prism({{0, 0},
                  {side, 0},
                  {side, height - side},
                  {2 * side, height - side},
                  {2 * side, height - side - tip},
                  {3 * side, height - side - tip},
                  {3 * side, height},
                  {0, height}},
                 side);
}

/// A cup about Z that stands on z = 0: outer and inner radius, height, floor.
inline TriMesh cup(double outer, double inner, double height, double floor, std::uint32_t around) {
    return revolved(floor, {{inner, floor}, {inner, height}, {outer, height}, {outer, 0}}, 0,
                    around);
}

}  // namespace tests
