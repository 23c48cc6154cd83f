// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/untangle.h"

#include "decomp/repair/surface_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <exception>

namespace decomp::repair {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

}  // namespace

decomp::Status untangle(mesh::TriMesh& mesh) {
    try {
        Surface surface;
        if (!to_surface(mesh, surface)) {
            return fail("repair.failed", "the surface is no oriented manifold");
        }
        if (!pmp::experimental::remove_self_intersections(
                surface, CGAL::parameters::preserve_genus(false))) {
            return fail("repair.failed", "crossings could not be removed");
        }
        surface.collect_garbage();
        mesh = from_surface(surface);
        return {};
    } catch (const std::exception& error) {
        return fail("repair.failed", std::string("removing crossings failed: ") + error.what());
    }
}

}  // namespace decomp::repair
