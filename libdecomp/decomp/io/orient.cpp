// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/orient.h"

#include "decomp/mesh/measure.h"

#include <array>
#include <cmath>
#include <utility>

namespace decomp::io {

namespace {

constexpr std::array<std::pair<Up, std::string_view>, 7> kNames{{{Up::Z, "z"},
                                                                 {Up::Y, "y"},
                                                                 {Up::MinusY, "-y"},
                                                                 {Up::X, "x"},
                                                                 {Up::MinusX, "-x"},
                                                                 {Up::MinusZ, "-z"},
                                                                 {Up::Auto, "auto"}}};

constexpr double kLevelCosine = 0.9961946980917455;  // of 5 degrees
constexpr double kBaseDepth = 0.005;                 // of the extent
constexpr double kLeastBase = 0.05;                  // of the bounding rectangle

/// The rotation that carries the up axis to +Z.
Eigen::Vector3d turned(const Eigen::Vector3d& p, Up up) {
    switch (up) {
        case Up::X:
            return {-p.z(), p.y(), p.x()};
        case Up::MinusX:
            return {p.z(), p.y(), -p.x()};
        case Up::Y:
            return {p.x(), -p.z(), p.y()};
        case Up::MinusY:
            return {p.x(), p.z(), -p.y()};
        case Up::MinusZ:
            return {p.x(), -p.y(), -p.z()};
        case Up::Z:
        case Up::Auto:
            break;
    }
    return p;
}

/// Area of the flat base under the shape when `up` points up, as a share of its bounding rectangle.
double base_share(const mesh::TriMesh& mesh, Up up) {
    Eigen::AlignedBox3d box;
    for (const auto& triangle : mesh.triangles) {
        for (const auto corner : triangle) {
            box.extend(turned(mesh.points[corner], up));
        }
    }
    const Eigen::Vector3d size = box.sizes();
    const double highest = box.min().z() + kBaseDepth * size.z();
    double area = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Eigen::Vector3d normal = turned(mesh::double_area_normal(mesh, i), up);
        const auto& t = mesh.triangles[i];
        const double top =
            std::max({turned(mesh.points[t[0]], up).z(), turned(mesh.points[t[1]], up).z(),
                      turned(mesh.points[t[2]], up).z()});
        if (top <= highest && -normal.z() >= kLevelCosine * normal.norm()) {
            area += normal.norm() / 2;
        }
    }
    const double rectangle = size.x() * size.y();
    return rectangle > 0 ? area / rectangle : 0;
}

}  // namespace

Result<Up> parse_up(std::string_view text) {
    for (const auto& [up, name] : kNames) {
        if (name == text) {
            return up;
        }
    }
    return fail("io.up", "there is no up axis '" + std::string(text) + "'", "up",
                "use x, -x, y, -y, z, -z or auto");
}

std::string_view name_of(Up up) {
    for (const auto& [known, name] : kNames) {
        if (known == up) {
            return name;
        }
    }
    return "auto";
}

Up choose_up(const mesh::TriMesh& mesh) {
    Up best = Up::Z;
    double best_share = kLeastBase;
    for (const auto& [up, name] : kNames) {
        const double share = up == Up::Auto ? 0 : base_share(mesh, up);
        if (share > best_share) {
            best = up;
            best_share = share;
        }
    }
    return best;
}

mesh::TriMesh to_model_frame(mesh::TriMesh mesh, Up up, std::optional<double> height_mm) {
    const Up chosen = up == Up::Auto ? choose_up(mesh) : up;
    for (auto& point : mesh.points) {
        point = turned(point, chosen);
    }
    const Eigen::AlignedBox3d box = mesh::bounds(mesh);
    if (height_mm && !box.isEmpty() && box.sizes().z() > 0) {
        const double factor = *height_mm / box.sizes().z();
        for (auto& point : mesh.points) {
            point *= factor;
        }
    }
    return mesh;
}

}  // namespace decomp::io
