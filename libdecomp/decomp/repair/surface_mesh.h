// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <type_traits>
#include <vector>

/// Between TriMesh and a halfedge mesh in CGAL's style; the kernel's headers stay in the .cpp
/// files.
namespace decomp::repair {

/// A coordinate as double, also of a kernel with numbers of its own.
template <class Number>
[[nodiscard]] double number(const Number& value) {
    if constexpr (std::is_same_v<Number, double>) {
        return value;
    } else {
        return to_double(value);
    }
}

/// False when the triangles do not form an oriented manifold (with or without border).
template <class Surface>
[[nodiscard]] bool to_surface(const mesh::TriMesh& mesh, Surface& surface) {
    surface.reserve(static_cast<typename Surface::size_type>(mesh.points.size()),
                    static_cast<typename Surface::size_type>(mesh.triangles.size() * 3 / 2 + 1),
                    static_cast<typename Surface::size_type>(mesh.triangles.size()));
    std::vector<typename Surface::Vertex_index> vertices;
    vertices.reserve(mesh.points.size());
    for (const auto& p : mesh.points) {
        vertices.push_back(surface.add_vertex(typename Surface::Point(p.x(), p.y(), p.z())));
    }
    for (const auto& t : mesh.triangles) {
        if (surface.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) ==
            Surface::null_face()) {
            return false;
        }
    }
    return true;
}

/// Points and triangles in the order of their indices, removed ones left out.
template <class Surface>
[[nodiscard]] mesh::TriMesh from_surface(const Surface& surface) {
    mesh::TriMesh mesh;
    std::vector<std::uint32_t> index(surface.number_of_vertices() +
                                     surface.number_of_removed_vertices());
    for (const auto vertex : surface.vertices()) {
        index[vertex] = static_cast<std::uint32_t>(mesh.points.size());
        const auto& p = surface.point(vertex);
        mesh.points.emplace_back(number(p.x()), number(p.y()), number(p.z()));
    }
    for (const auto face : surface.faces()) {
        mesh::Triangle triangle{};
        auto halfedge = surface.halfedge(face);
        for (auto& corner : triangle) {
            corner = index[surface.target(halfedge)];
            halfedge = surface.next(halfedge);
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

}  // namespace decomp::repair
