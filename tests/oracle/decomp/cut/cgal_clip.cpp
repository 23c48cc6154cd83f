// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/oracle/decomp/cut/cgal_clip.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Surface_mesh.h>

#include <exception>

namespace tests {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

Surface surface_of(const decomp::mesh::TriMesh& mesh) {
    Surface out;
    std::vector<Surface::Vertex_index> vertices;
    for (const auto& p : mesh.points) {
        vertices.push_back(out.add_vertex({p.x(), p.y(), p.z()}));
    }
    for (const auto& t : mesh.triangles) {
        out.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
    }
    return out;
}

}  // namespace

std::optional<double> clipped_volume(const decomp::mesh::TriMesh& mesh,
                                     const decomp::part::Plane& plane) {
    Surface surface = surface_of(mesh);
    const Kernel::Plane_3 cut(plane.normal.x(), plane.normal.y(), plane.normal.z(),
                              -plane.offset_mm);
    try {
        if (!CGAL::Polygon_mesh_processing::clip(surface, cut,
                                                 CGAL::parameters::clip_volume(true))) {
            return std::nullopt;
        }
    } catch (const std::exception&) {
        return std::nullopt;
    }
    return CGAL::to_double(CGAL::Polygon_mesh_processing::volume(surface));
}

std::optional<double> common_volume(const decomp::mesh::TriMesh& a,
                                    const decomp::mesh::TriMesh& b) {
    Surface left = surface_of(a);
    Surface right = surface_of(b);
    Surface out;
    try {
        if (!CGAL::Polygon_mesh_processing::corefine_and_compute_intersection(left, right, out)) {
            return std::nullopt;
        }
    } catch (const std::exception&) {
        return std::nullopt;
    }
    return CGAL::to_double(CGAL::Polygon_mesh_processing::volume(out));
}

}  // namespace tests
