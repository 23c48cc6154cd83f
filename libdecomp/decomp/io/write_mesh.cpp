// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/write_mesh.h"

#include "decomp/base/assert.h"
#include "decomp/base/number.h"
#include "decomp/io/byte_writer.h"

#include <Eigen/Geometry>

#include <cstdint>

namespace decomp::io {

std::string stl_bytes(const mesh::TriMesh& mesh) {
    std::string out =
        "binary STL, millimetres";  // must not begin with "solid": some readers take that for ASCII
    out.resize(80, ' ');
    out.reserve(84 + 50 * mesh.triangles.size());
    append_raw(out, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
        const Eigen::Vector3f a = mesh.points[triangle[0]].cast<float>();
        const Eigen::Vector3f b = mesh.points[triangle[1]].cast<float>();
        const Eigen::Vector3f c = mesh.points[triangle[2]].cast<float>();
        const Eigen::Vector3d cross = (b - a).cast<double>().cross((c - a).cast<double>());
        const double length = cross.norm();
        const Eigen::Vector3f normal = length > 0 ? Eigen::Vector3f((cross / length).cast<float>())
                                                  : Eigen::Vector3f(Eigen::Vector3f::Zero());
        for (const Eigen::Vector3f& vector : {normal, a, b, c}) {
            for (int axis = 0; axis < 3; ++axis) {
                append_raw(out, vector[axis] + 0.0F);  // no -0
            }
        }
        append_raw(out, std::uint16_t{0});
    }
    return out;
}

std::string ply_bytes(const mesh::TriMesh& mesh) { return ply_bytes(mesh, {}); }

std::string ply_bytes(const mesh::TriMesh& mesh,
                      const std::vector<std::array<std::uint8_t, 3>>& face_colours) {
    const bool coloured = !face_colours.empty();
    DECOMP_ASSERT(!coloured || face_colours.size() == mesh.triangles.size());
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment unit mm\nelement vertex " +
                      std::to_string(mesh.points.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(mesh.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\n";
    out += coloured ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "";
    out += "end_header\n";
    out.reserve(out.size() + 24 * mesh.points.size() + 16 * mesh.triangles.size());
    for (const auto& point : mesh.points) {
        for (int axis = 0; axis < 3; ++axis) {
            append_raw(out, point[axis]);
        }
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        append_raw(out, std::uint8_t{3});
        for (const std::uint32_t corner : mesh.triangles[i]) {
            append_raw(out, corner);
        }
        for (std::size_t channel = 0; coloured && channel < 3; ++channel) {
            append_raw(out, face_colours[i][channel]);
        }
    }
    return out;
}

std::string obj_bytes(const mesh::TriMesh& mesh) {
    std::string out = "# unit mm\n";
    for (const auto& point : mesh.points) {
        out += "v " + shortest(point.x()) + ' ' + shortest(point.y()) + ' ' + shortest(point.z()) +
               '\n';
    }
    for (const auto& triangle : mesh.triangles) {
        out += 'f';
        for (const std::uint32_t corner : triangle) {
            out += ' ' + std::to_string(std::uint64_t{corner} + 1);
        }
        out += '\n';
    }
    return out;
}

}  // namespace decomp::io
