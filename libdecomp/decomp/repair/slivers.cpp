// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/holes.h"
#include "decomp/repair/surface_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Surface_mesh.h>

#include <exception>
#include <iterator>

namespace decomp::repair {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

std::size_t count_slivers(const mesh::TriMesh& mesh) {
    std::size_t count = 0;
    const auto point = [&](std::uint32_t i) {
        return Kernel::Point_3(mesh.points[i].x(), mesh.points[i].y(), mesh.points[i].z());
    };
    for (const auto& t : mesh.triangles) {
        count += CGAL::collinear(point(t[0]), point(t[1]), point(t[2])) ? 1U : 0U;
    }
    return count;
}

}  // namespace

Result<std::size_t> remove_slivers(mesh::TriMesh& mesh) {
    try {
        const std::size_t count = count_slivers(mesh);
        if (count == 0) {
            return count;
        }
        Surface surface;
        if (!to_surface(mesh, surface)) {
            return fail("repair.failed",
                        "the surface around a triangle without area is no oriented manifold");
        }
        if (!pmp::remove_degenerate_faces(surface)) {
            return fail("repair.failed", "triangles without area could not be removed");
        }
        mesh = from_surface(surface);
        return count;
    } catch (const std::exception& error) {
        return fail("repair.failed",
                    std::string("removing triangles without area failed: ") + error.what());
    }
}

}  // namespace decomp::repair
