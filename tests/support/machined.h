// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/shapes.h"

/// Shapes as a CAD program exports them: flat sides, and holes of many chords.
namespace tests {

/// A plate [0, x] x [0, y] x [0, z] with one hole of this radius through its middle, of `around`
/// chords. Genus 1.
inline TriMesh drilled_plate(double x, double y, double z, double radius, std::uint32_t around) {
    TriMesh mesh;
    const auto add_ring = [&](double height) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double turn = 2 * std::numbers::pi * i / around;
            mesh.points.emplace_back(x / 2 + radius * std::cos(turn),
                                     y / 2 + radius * std::sin(turn), height);
        }
    };
    for (const double height : {0.0, z}) {
        mesh.points.emplace_back(x, 0, height);
        mesh.points.emplace_back(x, y, height);
        mesh.points.emplace_back(0, y, height);
        mesh.points.emplace_back(0, 0, height);
        add_ring(height);
    }
    const std::uint32_t layer = 4 + around;
    const auto corner = [&](std::uint32_t k, std::uint32_t top) { return top * layer + k % 4; };
    const auto ring = [&](std::uint32_t i, std::uint32_t top) {
        return top * layer + 4 + i % around;
    };
    // The ring's chord i belongs to the corner whose quarter it lies in: `around` divides by 4, and
    // corner k stands at 45 degrees before quarter k ends.
    for (std::uint32_t top = 0; top < 2; ++top) {
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            mesh.triangles.push_back(top == 1 ? decomp::mesh::Triangle{a, b, c}
                                              : decomp::mesh::Triangle{a, c, b});
        };
        for (std::uint32_t k = 0; k < 4; ++k) {
            const std::uint32_t nearest = (k + 1) % 4;  // corner (x, y) faces the first quarter
            for (std::uint32_t i = 0; i < around / 4; ++i) {
                const std::uint32_t at = k * around / 4 + i;
                add(ring(at + 1, top), ring(at, top), corner(nearest, top));
            }
            add(corner(nearest, top), corner(nearest + 1, top), ring((k + 1) * around / 4, top));
        }
    }
    for (std::uint32_t k = 0; k < 4; ++k) {
        mesh.triangles.push_back({corner(k, 0), corner(k + 1, 0), corner(k + 1, 1)});
        mesh.triangles.push_back({corner(k, 0), corner(k + 1, 1), corner(k, 1)});
    }
    for (std::uint32_t i = 0; i < around; ++i) {
        mesh.triangles.push_back({ring(i + 1, 0), ring(i, 0), ring(i, 1)});
        mesh.triangles.push_back({ring(i + 1, 0), ring(i, 1), ring(i + 1, 1)});
    }
    return mesh;
}

/// A plate [0, x] x [0, y] x [0, z] whose upright edges are rounded by `corner` and whose lower
/// edges by `fillet`, with so many chords to a quarter turn each.
inline TriMesh rounded_plate(double x, double y, double z, double corner, double fillet,
                             std::uint32_t around, std::uint32_t down) {
    TriMesh mesh;
    const std::uint32_t ring = 4 * (around + 1);
    const auto add_ring = [&](double inset, double height) {
        for (std::uint32_t k = 0; k < 4; ++k) {
            for (std::uint32_t i = 0; i <= around; ++i) {
                const double turn = std::numbers::pi / 2 * (k + static_cast<double>(i) / around);
                mesh.points.emplace_back(
                    (k == 0 || k == 3 ? x - corner : corner) + (corner - inset) * std::cos(turn),
                    (k < 2 ? y - corner : corner) + (corner - inset) * std::sin(turn), height);
            }
        }
    };
    for (std::uint32_t i = 0; i <= down; ++i) {
        const double turn = std::numbers::pi / 2 * i / down;
        add_ring(fillet * (1 - std::sin(turn)), fillet * (1 - std::cos(turn)));
    }
    add_ring(0, z);
    mesh.points.emplace_back(x / 2, y / 2, 0);
    mesh.points.emplace_back(x / 2, y / 2, z);
    const std::uint32_t top = (down + 1) * ring;
    for (std::uint32_t i = 0; i < ring; ++i) {
        const std::uint32_t j = (i + 1) % ring;
        for (std::uint32_t r = 0; r < top; r += ring) {
            mesh.triangles.push_back({r + i, r + j, r + ring + j});
            mesh.triangles.push_back({r + i, r + ring + j, r + ring + i});
        }
        mesh.triangles.push_back({top + ring, j, i});
        mesh.triangles.push_back({top + ring + 1, top + i, top + j});
    }
    return mesh;
}

/// A round bar about Z of `around` chords with flat ends.
inline TriMesh round_bar(double radius, double length, std::uint32_t around) {
    TriMesh mesh = revolved(length, {{radius, length}, {radius, 0}}, 0, around);
    return mesh;
}

}  // namespace tests
