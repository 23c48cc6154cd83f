// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/holes.h"

#include "decomp/mesh/measure.h"
#include "decomp/repair/surface_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <exception>
#include <iterator>

namespace decomp::repair {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

}  // namespace

Result<FilledHoles> fill_holes(mesh::TriMesh& mesh) {
    try {
        Surface surface;
        if (!to_surface(mesh, surface)) {
            return fail("repair.failed", "the surface around a hole is no oriented manifold");
        }
        std::vector<Surface::Halfedge_index> loops;
        pmp::extract_boundary_cycles(surface, std::back_inserter(loops));
        FilledHoles filled;
        for (const auto loop : loops) {
            std::vector<Surface::Face_index> patch;
            pmp::triangulate_hole(surface, loop, std::back_inserter(patch));
            if (patch.empty()) {
                return fail("repair.failed", "a hole could not be filled");
            }
            ++filled.holes;
            filled.triangles += patch.size();
        }
        const std::size_t before = mesh.triangles.size();
        mesh = from_surface(surface);
        for (std::size_t i = before; i < mesh.triangles.size(); ++i) {
            filled.area_mm2 += mesh::double_area_normal(mesh, i).norm() / 2;
        }
        return filled;
    } catch (const std::exception& error) {
        return fail("repair.failed", std::string("filling holes failed: ") + error.what());
    }
}

}  // namespace decomp::repair
