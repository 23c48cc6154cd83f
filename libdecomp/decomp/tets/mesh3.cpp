// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/meshers_detail.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/make_mesh_3.h>

#include <exception>
#include <map>
#include <string>

namespace decomp::tets {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Domain = CGAL::Polyhedral_mesh_domain_3<Surface, Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

constexpr double kFacetAngleDeg = 25;
constexpr double kFacetDistance = 0.1;  // of the edge length
constexpr double kCellSize = 1.2;       // of the edge length
constexpr double kRadiusToEdge = 3;

Surface surface_of(const mesh::TriMesh& mesh) {
    Surface surface;
    for (const Eigen::Vector3d& p : mesh.points) {
        surface.add_vertex({p.x(), p.y(), p.z()});
    }
    for (const mesh::Triangle& t : mesh.triangles) {
        surface.add_face(Surface::Vertex_index(t[0]), Surface::Vertex_index(t[1]),
                         Surface::Vertex_index(t[2]));
    }
    return surface;
}

TetMesh tets_of(const Complex& complex) {
    TetMesh mesh;
    std::map<Triangulation::Vertex_handle, std::uint32_t> number;
    for (auto v = complex.triangulation().finite_vertices_begin();
         v != complex.triangulation().finite_vertices_end(); ++v) {
        number.emplace(v, 0);
    }
    for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
         ++cell) {
        for (int k = 0; k < 4; ++k) {
            number[cell->vertex(k)] = 1;
        }
    }
    // By the order of the triangulation's own list, not by address.
    for (auto v = complex.triangulation().finite_vertices_begin();
         v != complex.triangulation().finite_vertices_end(); ++v) {
        std::uint32_t& mine = number[v];
        if (mine == 1) {
            mine = static_cast<std::uint32_t>(mesh.points.size());
            const auto& p = v->point();
            mesh.points.emplace_back(p.x(), p.y(), p.z());
        }
    }
    for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
         ++cell) {
        mesh.tets.push_back({number[cell->vertex(0)], number[cell->vertex(1)],
                             number[cell->vertex(2)], number[cell->vertex(3)]});
    }
    return mesh;
}

}  // namespace

Result<TetMesh> mesh3_tets(const mesh::TriMesh& surface, double edge_mm) {
    try {
        const Surface cgal = surface_of(surface);
        CGAL::Random random(0);
        const Domain domain(cgal, &random);
        const Criteria criteria(CGAL::parameters::facet_angle = kFacetAngleDeg,
                                CGAL::parameters::facet_size = edge_mm,
                                CGAL::parameters::facet_distance = kFacetDistance * edge_mm,
                                CGAL::parameters::cell_radius_edge_ratio = kRadiusToEdge,
                                CGAL::parameters::cell_size = kCellSize * edge_mm);
        const auto complex =
            CGAL::make_mesh_3<Complex>(domain, criteria, CGAL::parameters::no_perturb(),
                                       CGAL::parameters::no_exude(), CGAL::parameters::manifold());
        TetMesh mesh = tets_of(complex);
        if (mesh.tets.empty()) {
            return fail("tets.failed", "Mesh_3 found nothing inside the surface");
        }
        return mesh;
    } catch (const std::exception& fault) {
        return fail("tets.failed", std::string("Mesh_3 gave up: ") + fault.what());
    }
}

}  // namespace decomp::tets
