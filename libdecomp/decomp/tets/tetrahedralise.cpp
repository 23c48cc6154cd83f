// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/tetrahedralise.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/tets/boundary.h"
#include "decomp/tets/measure.h"
#include "decomp/tets/meshers_detail.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace decomp::tets {

namespace {

constexpr double kVolumeTolerance = 1e-6;  // share by which the tets' volume may be off
constexpr double kAnewTolerance = 0.25;    // the same where the surface is sampled anew

mesh::Triangle sorted(mesh::Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
}

Status check_surface(const mesh::TriMesh& surface) {
    const mesh::TopologyReport topology = mesh::check_topology(surface);
    if (surface.triangles.empty() || topology.border_edges > 0 || topology.misoriented_edges > 0 ||
        !(mesh::volume_mm3(surface) > 0)) {
        return fail("tets.bad_surface", "the surface to be filled is not closed and outward", {},
                    "repair it first");
    }
    return {};
}

void make_positive(TetMesh& mesh) {
    for (Tet& tet : mesh.tets) {
        if (six_volumes(mesh.points, tet) < 0) {
            std::swap(tet[2], tet[3]);
        }
    }
}

/// Why these tets do not fill the surface; empty when they do.
std::string fault_of(const TetMesh& mesh, const mesh::TriMesh& surface) {
    double volume = 0;
    for (const Tet& tet : mesh.tets) {
        const double six = six_volumes(mesh.points, tet);
        if (!(six > 0)) {
            return "a tet has no volume";
        }
        volume += six / 6;
    }
    const double wanted = mesh::volume_mm3(surface);
    if (std::abs(volume - wanted) > kVolumeTolerance * wanted) {
        return "the tets' volume is not the surface's";
    }
    std::vector<mesh::Triangle> mine;
    for (const BoundaryFacet& facet : boundary_of(mesh.tets)) {
        mine.push_back(sorted(facet.corners));
    }
    std::vector<mesh::Triangle> theirs;
    for (const mesh::Triangle& t : surface.triangles) {
        theirs.push_back(sorted(t));
    }
    std::sort(mine.begin(), mine.end());
    std::sort(theirs.begin(), theirs.end());
    return mine == theirs ? std::string() : "the boundary is not the surface";
}

}  // namespace

Result<TetMesh> tetrahedralise(const mesh::TriMesh& surface, Run& run) {
    if (Status status = check_surface(surface); !status) {
        return fail(status.error());
    }
    if (run.cancelled()) {
        return cancelled();
    }
    Result<TetMesh> mesh = gmsh_tets(surface);
    if (!mesh) {
        return mesh;
    }
    make_positive(*mesh);
    if (const std::string fault = fault_of(*mesh, surface); !fault.empty()) {
        return fail("tets.failed", "the surface cannot be filled with tets: " + fault, {},
                    "look for places where the surface nearly touches itself");
    }
    return mesh;
}

Result<TetMesh> tetrahedralise_anew(const mesh::TriMesh& surface, double edge_mm, Run& run) {
    if (Status status = check_surface(surface); !status) {
        return fail(status.error());
    }
    if (run.cancelled()) {
        return cancelled();
    }
    Result<TetMesh> mesh = mesh3_tets(surface, edge_mm);
    if (!mesh) {
        return mesh;
    }
    make_positive(*mesh);
    std::erase_if(mesh->tets,
                  [&](const Tet& tet) { return !(six_volumes(mesh->points, tet) > 0); });
    double volume = 0;
    for (const Tet& tet : mesh->tets) {
        volume += six_volumes(mesh->points, tet) / 6;
    }
    const double wanted = mesh::volume_mm3(surface);
    if (std::abs(volume - wanted) > kAnewTolerance * wanted) {
        return fail("tets.failed", "the tets sampled anew miss too much of the volume", {},
                    "try a finer proxy");
    }
    return mesh;
}

}  // namespace decomp::tets
