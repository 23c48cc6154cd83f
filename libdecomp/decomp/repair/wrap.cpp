// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/wrap.h"

#include "decomp/repair/surface_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <exception>

namespace decomp::repair {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

}  // namespace

Result<mesh::TriMesh> wrap(const mesh::TriMesh& soup, double alpha_mm, double offset_mm) {
    try {
        std::vector<Kernel::Point_3> points;
        points.reserve(soup.points.size());
        for (const auto& p : soup.points) {
            points.emplace_back(p.x(), p.y(), p.z());
        }
        std::vector<std::array<std::size_t, 3>> triangles;
        triangles.reserve(soup.triangles.size());
        for (const auto& t : soup.triangles) {
            triangles.push_back({t[0], t[1], t[2]});
        }
        Surface out;
        CGAL::alpha_wrap_3(points, triangles, alpha_mm, offset_mm, out);
        out.collect_garbage();
        return from_surface(out);
    } catch (const std::exception& error) {
        return fail("repair.failed", std::string("wrapping failed: ") + error.what());
    }
}

}  // namespace decomp::repair
