// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/proxy.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <array>
#include <cstdint>
#include <exception>
#include <limits>
#include <vector>

namespace decomp::pipeline {

namespace {

namespace collapse = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using EdgeFlags = Surface::Property_map<Surface::Edge_index, bool>;
using FaceOrigins = Surface::Property_map<Surface::Face_index, std::uint32_t>;

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// False when the part is not an edge-manifold surface in the sense of a halfedge structure.
bool fill(Surface& surface, const part::Part& part, FaceOrigins& origins) {
    std::vector<Surface::Vertex_index> vertices(part.mesh.points.size(), Surface::null_vertex());
    for (std::uint32_t i = 0; i < part.mesh.triangles.size(); ++i) {
        std::array<Surface::Vertex_index, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = part.mesh.triangles[i].at(k);
            if (vertices[v] == Surface::null_vertex()) {
                const Eigen::Vector3d& p = part.mesh.points[v];
                vertices[v] = surface.add_vertex({p.x(), p.y(), p.z()});
            }
            corners.at(k) = vertices[v];
        }
        const Surface::Face_index face = surface.add_face(corners[0], corners[1], corners[2]);
        if (face == Surface::null_face()) {
            return false;
        }
        origins[face] = i;
    }
    return true;
}

part::Part read_back(const Surface& surface, const part::Part& part, const FaceOrigins& origins) {
    part::Part out;
    out.id = part.id;
    std::vector<std::uint32_t> index(
        surface.number_of_vertices() + surface.number_of_removed_vertices(), kUnused);
    for (const Surface::Face_index face : surface.faces()) {
        mesh::Triangle triangle{};
        std::size_t corner = 0;
        for (const Surface::Vertex_index v : surface.vertices_around_face(surface.halfedge(face))) {
            if (index[v] == kUnused) {
                index[v] = static_cast<std::uint32_t>(out.mesh.points.size());
                const Kernel::Point_3& p = surface.point(v);
                out.mesh.points.emplace_back(p.x(), p.y(), p.z());
            }
            triangle.at(corner++) = index[v];
        }
        out.mesh.triangles.push_back(triangle);
        out.sources.push_back(part.sources[origins[face]]);
    }
    return out;
}

/// Marks the edges of the cut faces: they stay where they are.
void fix_cut_faces(const Surface& surface, const part::Part& part, const FaceOrigins& origins,
                   EdgeFlags& fixed) {
    for (const Surface::Face_index face : surface.faces()) {
        if (!part.sources[origins[face]].is_cut()) {
            continue;
        }
        for (const Surface::Halfedge_index h :
             surface.halfedges_around_face(surface.halfedge(face))) {
            fixed[surface.edge(h)] = true;
        }
    }
}

}  // namespace

part::Part simplified(const part::Part& part, std::size_t triangles) {
    if (part.mesh.triangles.size() <= triangles + triangles / 4) {
        return part;
    }
    try {
        Surface surface;
        FaceOrigins origins =
            surface.add_property_map<Surface::Face_index, std::uint32_t>("f:origin", 0).first;
        if (!fill(surface, part, origins) || !CGAL::is_closed(surface)) {
            return part;
        }
        EdgeFlags fixed =
            surface.add_property_map<Surface::Edge_index, bool>("e:fixed", false).first;
        fix_cut_faces(surface, part, origins, fixed);
        using Placement = collapse::LindstromTurk_placement<Surface>;
        collapse::edge_collapse(
            surface, collapse::Count_stop_predicate<Surface>(triangles * 3 / 2),
            CGAL::parameters::edge_is_constrained_map(fixed)
                .get_cost(collapse::LindstromTurk_cost<Surface>())
                .get_placement(collapse::Constrained_placement<Placement, EdgeFlags>(fixed)));
        return read_back(surface, part, origins);
    } catch (const std::exception&) {
        return part;  // a degenerate surface: the search is slower, not wrong
    }
}

}  // namespace decomp::pipeline
