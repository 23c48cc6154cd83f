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

/// A round bar about Z of `around` chords with flat ends.
inline TriMesh round_bar(double radius, double length, std::uint32_t around) {
    TriMesh mesh = revolved(length, {{radius, length}, {radius, 0}}, 0, around);
    return mesh;
}

}  // namespace tests
