// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/boolean.h"

#include "decomp/repair/surface_mesh.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <optional>

namespace decomp::repair {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

constexpr std::array<double, 4> kShrinks{0, 1e-6, 1e-5, 1e-4};

/// A surface, and how far a part of it was shifted.
struct Operand {
    Surface surface;
    double shrunk_mm = 0;
};

/// Moves the points towards the centre of the bounds; returns the largest shift.
double shrink(Surface& surface, double share) {
    const CGAL::Bbox_3 box = pmp::bbox(surface);
    const Kernel::Point_3 centre((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2,
                                 (box.zmin() + box.zmax()) / 2);
    for (const auto vertex : surface.vertices()) {
        surface.point(vertex) = centre + Kernel::FT(1 - share) * (surface.point(vertex) - centre);
    }
    const double x = box.xmax() - box.xmin();
    const double y = box.ymax() - box.ymin();
    const double z = box.zmax() - box.zmin();
    return share * std::sqrt(x * x + y * y + z * z) / 2;
}

enum class Operation { Union, Difference };

/// Nothing when an operand is unfit or no shrinking makes the result a manifold.
std::optional<Operand> combined(const Operand& a, const Operand& b, Operation operation) {
    for (const double share : kShrinks) {
        // Corefinement cuts its operands, also when it fails: it works on copies.
        Surface left = a.surface;
        Surface right = b.surface;
        Operand out;
        out.shrunk_mm = std::max(a.shrunk_mm, b.shrunk_mm);
        if (share > 0) {
            out.shrunk_mm = std::max(out.shrunk_mm, shrink(right, share));
        }
        const auto strict = CGAL::parameters::throw_on_self_intersection(true);
        const bool done =
            operation == Operation::Union
                ? pmp::corefine_and_compute_union(left, right, out.surface, strict)
                : pmp::corefine_and_compute_difference(left, right, out.surface, strict);
        if (done) {
            out.surface.collect_garbage();
            return out;
        }
    }
    return std::nullopt;
}

/// Unites neighbours in the order given, then the results, until one is left: no surface takes part
/// in more than a logarithmic number of unions.
std::optional<Operand> united(const std::vector<mesh::TriMesh>& solids, const Run& run) {
    std::vector<Operand> row(solids.size());
    for (std::size_t i = 0; i < solids.size(); ++i) {
        if (!to_surface(solids[i], row[i].surface)) {
            return std::nullopt;
        }
    }
    while (row.size() > 1) {
        std::vector<Operand> next;
        for (std::size_t i = 0; i < row.size(); i += 2) {
            if (run.cancelled()) {
                return std::nullopt;
            }
            if (i + 1 == row.size()) {
                next.push_back(std::move(row[i]));
                continue;
            }
            std::optional<Operand> sum = combined(row[i], row[i + 1], Operation::Union);
            if (!sum) {
                return std::nullopt;
            }
            next.push_back(std::move(*sum));
        }
        row = std::move(next);
    }
    return std::move(row.front());
}

mesh::TriMesh rounded(const Surface& surface) {
    for (const auto vertex : surface.vertices()) {
        CGAL::exact(surface.point(vertex));  // else the double is only the middle of an interval
    }
    mesh::TriMesh mesh;
    for (const auto vertex : surface.vertices()) {
        const auto& p = surface.point(vertex);
        mesh.points.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()),
                                 CGAL::to_double(p.z()));
    }
    for (const auto face : surface.faces()) {
        mesh::Triangle triangle{};
        auto halfedge = surface.halfedge(face);
        for (auto& corner : triangle) {
            corner = static_cast<std::uint32_t>(surface.target(halfedge).idx());
            halfedge = surface.next(halfedge);
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

}  // namespace

Result<BooleanResult> exact_boolean(const std::vector<mesh::TriMesh>& added,
                                    const std::vector<mesh::TriMesh>& removed, const Run& run) {
    try {
        std::optional<Operand> body = united(added, run);
        if (body && !removed.empty()) {
            const std::optional<Operand> cavity = united(removed, run);
            body = cavity ? combined(*body, *cavity, Operation::Difference) : std::nullopt;
        }
        if (run.cancelled()) {
            return cancelled();
        }
        if (!body) {
            return fail("repair.failed", "shells that overlap have no union that is a manifold");
        }
        return BooleanResult{rounded(body->surface), body->shrunk_mm};
    } catch (const std::exception& error) {
        return fail("repair.failed", std::string("uniting shells failed: ") + error.what());
    }
}

}  // namespace decomp::repair
