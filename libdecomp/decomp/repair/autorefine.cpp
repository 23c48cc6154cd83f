// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/resolve.h"
#include "decomp/repair/soup.h"
#include "decomp/repair/surface_mesh.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <exception>

namespace decomp::repair {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

}  // namespace

Result<mesh::TriMesh> cut_along_crossings(const mesh::TriMesh& mesh) {
    try {
        Surface surface;
        if (!to_surface(mesh, surface)) {
            return fail("repair.failed", "the surface is no oriented manifold");
        }
        pmp::experimental::autorefine(surface);
        for (const auto vertex : surface.vertices()) {
            CGAL::exact(
                surface.point(vertex));  // else the double is only the middle of an interval
        }
        surface.collect_garbage();
        mesh::TriMesh cut = from_surface(surface);
        weld(cut);
        drop_degenerate(cut);
        return cut;
    } catch (const std::exception& error) {
        return fail("repair.failed",
                    std::string("cutting along crossings failed: ") + error.what());
    }
}

}  // namespace decomp::repair
