// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/oracle/decomp/partition/checker.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <vector>

namespace tests {

bool crosses_itself(const decomp::mesh::TriMesh& mesh) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
    Surface surface;
    std::vector<Surface::Vertex_index> vertices;
    for (const auto& p : mesh.points) {
        vertices.push_back(surface.add_vertex({p.x(), p.y(), p.z()}));
    }
    for (const auto& t : mesh.triangles) {
        if (surface.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) ==
            Surface::null_face()) {
            return false;  // not manifold: another fault
        }
    }
    return CGAL::Polygon_mesh_processing::does_self_intersect(surface);
}

}  // namespace tests
