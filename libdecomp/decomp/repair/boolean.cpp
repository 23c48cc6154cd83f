// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/boolean.h"

#include "decomp/repair/surface_mesh.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <exception>
#include <optional>

namespace decomp::repair {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

/// Unites one after another, in the order given. Nothing when an operand is unfit or a result is no
/// manifold.
std::optional<Surface> united(const std::vector<mesh::TriMesh>& solids, const Run& run) {
    Surface sum;
    for (std::size_t i = 0; i < solids.size(); ++i) {
        Surface next;
        if (run.cancelled() || !to_surface(solids[i], next)) {
            return std::nullopt;
        }
        if (i == 0) {
            sum = std::move(next);
            continue;
        }
        Surface out;
        if (!pmp::corefine_and_compute_union(sum, next, out,
                                             CGAL::parameters::throw_on_self_intersection(true))) {
            return std::nullopt;
        }
        out.collect_garbage();
        sum = std::move(out);
    }
    return sum;
}

mesh::TriMesh rounded(const Surface& surface) {
    for (const auto vertex : surface.vertices()) {
        CGAL::exact(surface.point(vertex));  // else the double is only the middle of an interval
    }
    Surface compact = surface;
    compact.collect_garbage();
    mesh::TriMesh mesh;
    for (const auto vertex : compact.vertices()) {
        const auto& p = compact.point(vertex);
        mesh.points.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()),
                                 CGAL::to_double(p.z()));
    }
    for (const auto face : compact.faces()) {
        mesh::Triangle triangle{};
        auto halfedge = compact.halfedge(face);
        for (auto& corner : triangle) {
            corner = static_cast<std::uint32_t>(compact.target(halfedge).idx());
            halfedge = compact.next(halfedge);
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

}  // namespace

Result<mesh::TriMesh> exact_boolean(const std::vector<mesh::TriMesh>& added,
                                    const std::vector<mesh::TriMesh>& removed, const Run& run) {
    const auto no_manifold = [&]() -> tl::unexpected<Error> {
        return run.cancelled()
                   ? cancelled()
                   : fail("repair.failed", "shells that overlap have no union that is a manifold");
    };
    try {
        std::optional<Surface> sum = united(added, run);
        if (!sum) {
            return no_manifold();
        }
        if (removed.empty()) {
            return rounded(*sum);
        }
        std::optional<Surface> cavity = united(removed, run);
        Surface out;
        if (!cavity ||
            !pmp::corefine_and_compute_difference(
                *sum, *cavity, out, CGAL::parameters::throw_on_self_intersection(true))) {
            return no_manifold();
        }
        return rounded(out);
    } catch (const std::exception& error) {
        return fail("repair.failed", std::string("uniting shells failed: ") + error.what());
    }
}

}  // namespace decomp::repair
