// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/implicit.h"

#include <string>

/// Shapes with handles, 60 to 120 mm across, made in code.
namespace tests {

struct HandleShape {
    std::string name;
    int genus = 0;
    decomp::mesh::TriMesh mesh;
};

/// A torus that leans, with bumps all over: genus 1.
inline HandleShape bumpy_torus(double lean, double bump_mm) {
    const Eigen::Vector3d axis(std::sin(lean), 0.3 * std::sin(lean), std::cos(lean));
    const Field field = [=](const Eigen::Vector3d& p) {
        const double bumps =
            std::sin(0.23 * p.x()) * std::sin(0.21 * p.y() + 1) * std::sin(0.25 * p.z() + 2);
        return torus_field(p, Eigen::Vector3d::Zero(), axis.normalized(), 30, 11) - bump_mm * bumps;
    };
    return {"bumpy torus", 1, surface_of(field, {-50, -50, -50}, {50, 50, 50}, 2)};
}

/// Links grown together, each turned against the one before: genus = links.
inline HandleShape chain(int links) {
    const double reach = 26;
    const Field field = [=](const Eigen::Vector3d& p) {
        double d = 1e9;
        for (int i = 0; i < links; ++i) {
            const double turn = 0.9 * i;
            d = blended(
                d, torus_field(p, {reach * i, 0, 0}, {0, std::sin(turn), std::cos(turn)}, 14, 5.5),
                3);
        }
        return d;
    };
    return {"chain of " + std::to_string(links), links,
            surface_of(field, {-25, -25, -25}, {reach * (links - 1) + 25, 25, 25}, 1.5)};
}

/// A cup with a handle: genus 1.
inline HandleShape mug() {
    const Field field = [](const Eigen::Vector3d& p) {
        const double cup =
            std::max(cylinder_field(p, 30, -40, 40, 4), -cylinder_field(p, 23, -33, 60, 4));
        const double handle = torus_field(p, {33, 0, 0}, {0, 1, 0}, 20, 5);
        const double hollow = cylinder_field(p, 26, -33, 60, 4);
        return blended(cup, std::max(handle, -hollow), 4);
    };
    return {"mug", 1, surface_of(field, {-35, -35, -45}, {65, 35, 45}, 2)};
}

/// A palm with five fingers, thumb and forefinger closed to a ring: genus 1.
inline HandleShape hand() {
    const Field field = [](const Eigen::Vector3d& p) {
        double d = capsule_field(p, {-14, 0, 0}, {14, 0, 6}, 15);
        d = blended(d, capsule_field(p, {0, 0, -30}, {0, 0, -5}, 13), 8);
        const Eigen::Vector3d tip(38, 14, 40);
        d = blended(d, capsule_field(p, {-20, 0, 8}, {-30, -6, 50}, 6), 4);
        d = blended(d, capsule_field(p, {-8, 0, 12}, {-11, -3, 62}, 6.5), 4);
        d = blended(d, capsule_field(p, {6, 0, 14}, {10, 0, 60}, 6.5), 4);
        d = blended(d, capsule_field(p, {18, 2, 12}, {30, 6, 50}, 6), 4);
        d = blended(d, capsule_field(p, {30, 6, 50}, tip, 6), 3);
        d = blended(d, capsule_field(p, {16, 0, -6}, {46, 10, 12}, 7), 5);
        return blended(d, capsule_field(p, {46, 10, 12}, tip, 6), 3);
    };
    return {"hand", 1, surface_of(field, {-45, -35, -55}, {65, 35, 80}, 2)};
}

/// Three holes around a point, in a bent sheet: genus 3.
inline HandleShape pretzel() {
    const Field field = [](const Eigen::Vector3d& p) {
        const Eigen::Vector3d q(p.x(), p.y(), p.z() - 0.006 * p.squaredNorm() + 6);
        double d = 1e9;
        for (int i = 0; i < 3; ++i) {
            const double turn = 2 * std::numbers::pi * i / 3 + 0.3;
            d = blended(
                d,
                torus_field(q, {20 * std::cos(turn), 20 * std::sin(turn), 0}, {0, 0, 1}, 16, 6.5),
                3);
        }
        return d;
    };
    return {"pretzel", 3, surface_of(field, {-50, -50, -30}, {50, 50, 40}, 1.5)};
}

/// A tube along a trefoil knot: genus 1.
inline HandleShape knot() {
    std::vector<Eigen::Vector3d> path;
    constexpr int kSteps = 120;
    for (int i = 0; i < kSteps; ++i) {
        const double t = 2 * std::numbers::pi * i / kSteps;
        path.emplace_back(14 * (std::sin(t) + 2 * std::sin(2 * t)),
                          14 * (std::cos(t) - 2 * std::cos(2 * t)), -16 * std::sin(3 * t));
    }
    const Field field = [path](const Eigen::Vector3d& p) {
        double d = 1e9;
        for (std::size_t i = 0; i < path.size(); ++i) {
            d = std::min(d, capsule_field(p, path[i], path[(i + 1) % path.size()], 7));
        }
        return d;
    };
    return {"trefoil knot", 1, surface_of(field, {-60, -60, -35}, {60, 60, 35}, 2)};
}

/// A ball on three legs that meet in a ring: genus 3.
inline HandleShape stool() {
    const Field field = [](const Eigen::Vector3d& p) {
        double d = (p - Eigen::Vector3d(0, 0, 40)).norm() - 20;
        d = blended(d, torus_field(p, {0, 0, 0}, {0, 0, 1}, 28, 6), 4);
        for (int i = 0; i < 3; ++i) {
            const double turn = 2 * std::numbers::pi * i / 3 + 0.4;
            const Eigen::Vector3d foot(34 * std::cos(turn), 34 * std::sin(turn), -25);
            d = blended(d, capsule_field(p, {0.3 * foot.x(), 0.3 * foot.y(), 32}, foot, 6), 4);
        }
        return d;
    };
    return {"stool", 3, surface_of(field, {-50, -50, -40}, {50, 50, 65}, 2)};
}

inline std::vector<HandleShape> handle_shapes() {
    return {bumpy_torus(0.6, 3),
            bumpy_torus(1.1, 5),
            chain(2),
            chain(3),
            chain(5),
            mug(),
            hand(),
            pretzel(),
            knot(),
            stool()};
}

}  // namespace tests
