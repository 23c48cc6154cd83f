// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/shading_detail.h"
#include "decomp/mesh/measure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cam::render {

namespace {

constexpr double kCreaseCosine = 0.82;  // 35 degrees
constexpr std::size_t kGreatestFan =
    64;  // a vertex with more triangles (a cap's centre) is taken as flat
constexpr double kLampRight = -0.45;
constexpr double kLampUp = 0.65;
constexpr double kLampToward = 0.62;
constexpr double kLampLight = 0.52;
constexpr double kHeadLight = 0.16;
constexpr double kSkyLight = 0.26;
constexpr double kAmbientLight = 0.12;  // reaches every hollow
constexpr double kShade = 0.35;         // of the lamps, taken where no sky is seen

/// Triangles around each vertex: those of vertex v are list[first[v]] ... list[first[v + 1] - 1],
/// ascending.
struct Fans {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> list;
};

Fans fans_of(const decomp::mesh::TriMesh& mesh) {
    Fans fans;
    fans.first.assign(mesh.points.size() + 1, 0);
    for (const auto& triangle : mesh.triangles) {
        for (const auto corner : triangle) {
            ++fans.first[corner + 1];
        }
    }
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        fans.first[v + 1] += fans.first[v];
    }
    fans.list.resize(3 * mesh.triangles.size());
    std::vector<std::uint32_t> next(fans.first.begin(), fans.first.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const auto corner : mesh.triangles[t]) {
            fans.list[next[corner]++] = static_cast<std::uint32_t>(t);
        }
    }
    return fans;
}

/// The four bits of 0 ... 15 in reverse order, as a fraction of 16.
double reversed(int number) {
    const auto bits = static_cast<unsigned>(number);
    const unsigned turned =
        ((bits & 1U) << 3U) | ((bits & 2U) << 1U) | ((bits & 4U) >> 1U) | ((bits & 8U) >> 3U);
    return static_cast<double>(turned) / kSkyDirections;
}

}  // namespace

std::vector<Eigen::Vector3f> corner_normals(const decomp::mesh::TriMesh& mesh) {
    const std::size_t count = mesh.triangles.size();
    std::vector<Eigen::Vector3d> weighted(count);
    std::vector<Eigen::Vector3d> unit(count);
    for (std::size_t t = 0; t < count; ++t) {
        weighted[t] = decomp::mesh::double_area_normal(mesh, t);
        unit[t] = weighted[t].stableNormalized();
    }
    const Fans fans = fans_of(mesh);
    std::vector<Eigen::Vector3f> normals(3 * count);
    const auto smooth_at = [&](std::size_t t, std::uint32_t vertex) {
        const std::size_t begin = fans.first[vertex];
        const std::size_t end = fans.first[vertex + 1];
        Eigen::Vector3d sum = weighted[t];
        for (std::size_t i = begin; i < end && end - begin <= kGreatestFan; ++i) {
            const std::size_t other = fans.list[i];
            if (other != t && unit[other].dot(unit[t]) > kCreaseCosine) {
                sum += weighted[other];
            }
        }
        return sum.stableNormalized().cast<float>().eval();
    };
    for (std::size_t t = 0; t < count; ++t) {
        for (std::size_t c = 0; c < 3; ++c) {
            normals[3 * t + c] = smooth_at(t, mesh.triangles[t].at(c));
        }
    }
    return normals;
}

double light_on(const Eigen::Vector3f& normal, const Camera& camera, double open) {
    static const Eigen::Vector3d lamp_of_camera =
        Eigen::Vector3d(kLampRight, kLampUp, kLampToward).normalized();
    const Eigen::Vector3d n = normal.cast<double>();
    const Eigen::Vector3d lamp = lamp_of_camera.x() * camera.right +
                                 lamp_of_camera.y() * camera.up +
                                 lamp_of_camera.z() * camera.toward_viewer;
    const double from_lamp = std::max(0.0, n.dot(lamp));
    const double from_head = std::max(0.0, n.dot(camera.toward_viewer));
    const double reached = 1 - kShade * (1 - open);
    return (kLampLight * from_lamp + kHeadLight * from_head) * reached + kSkyLight * open +
           kAmbientLight;
}

Eigen::Vector3f sky_direction(const Eigen::Vector3f& normal, int index, int slot) {
    // Hammersley: equal steps along one side of the square, bits reversed along the other; each of
    // the pixels of a tile has its own place within every step.
    const double along = (index + (slot + 0.5) / kSkyDirections) / kSkyDirections;
    const double circle = reversed(index) + reversed(slot) / kSkyDirections;
    const double sine = std::sqrt(along);
    const double angle = 2 * std::numbers::pi * circle;
    const Eigen::Vector3d n = normal.cast<double>();
    const Eigen::Vector3d side =
        (std::abs(n.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY())
            .cross(n)
            .normalized();
    const Eigen::Vector3d other = n.cross(side);
    return (side * (sine * std::cos(angle)) + other * (sine * std::sin(angle)) +
            n * std::sqrt(1 - along))
        .cast<float>();
}

}  // namespace cam::render
