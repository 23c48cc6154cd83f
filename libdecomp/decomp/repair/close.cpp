// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/edges.h"
#include "decomp/repair/holes.h"
#include "decomp/repair/soup.h"
#include "decomp/repair/work.h"

#include <Eigen/Geometry>

#include <optional>

namespace decomp::repair {

namespace {

constexpr std::size_t kFewBorderEdges = 16;  // holes that are filled however small the mesh
constexpr double kLargestPatchShare = 0.3;   // of the area of the shell that it closes
constexpr double kLargestSheetShare = 0.1;   // of all area, for loose sheets that are dropped

/// One component of the mesh, and its border.
struct Piece {
    std::size_t triangles = 0;
    std::size_t border_edges = 0;
    double area_mm2 = 0;

    [[nodiscard]] bool may_be_filled(double share) const {
        const double edges =
            (3.0 * static_cast<double>(triangles) + static_cast<double>(border_edges)) / 2;
        return border_edges <= kFewBorderEdges ||
               static_cast<double>(border_edges) <= share * edges;
    }
};

std::vector<Piece> pieces_of(const mesh::TriMesh& mesh, const Components& parts) {
    std::vector<Piece> pieces(parts.count);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        ++pieces[parts.of_triangle[i]].triangles;
        pieces[parts.of_triangle[i]].area_mm2 += mesh::double_area_normal(mesh, i).norm() / 2;
    }
    const std::vector<Side> sides = sorted_sides(mesh);
    for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
        if (end - begin == 1) {
            ++pieces[parts.of_triangle[sides[begin].triangle]].border_edges;
        }
    });
    return pieces;
}

void orient_and_split(Work& work) {
    if (const std::size_t turned = orient_consistently(work.mesh); turned > 0) {
        work.senses_trusted = false;
        work.change(Status::Fixed,
                    "turned " + counted(turned, "triangle") + " to face as the neighbours do");
    }
    if (const std::size_t added = split_non_manifold(work.mesh); added > 0) {
        work.change(Status::Fixed, "cut the surface apart where it touches itself, doubling " +
                                       counted(added, "point"));
    }
}

void merge_near(Work& work) {
    const double reach = work.options.near_share * mesh::diagonal_mm(work.mesh);
    const NearMerge merge = merge_near_border(work.mesh, reach);
    if (merge.points > 0) {
        work.surface_moved = true;
        work.change(Status::Fixed, "moved " + counted(merge.points, "point") +
                                       " at open edges by up to " + figure(merge.farthest_mm) +
                                       " mm to close them");
    }
}

/// Fills the holes of one piece. Nothing when that gives no body.
std::optional<mesh::TriMesh> filled_piece(Work& work, mesh::TriMesh piece) {
    const Result<FilledHoles> filled = fill_holes(piece);
    if (!filled || filled->area_mm2 > kLargestPatchShare * mesh::area_mm2(piece)) {
        return std::nullopt;
    }
    work.surface_moved = true;
    work.change(Status::Fixed, "filled " + counted(filled->holes, "hole") + " with " +
                                   counted(filled->triangles, "triangle") + ", " +
                                   figure(filled->area_mm2) + " mm^2");
    return piece;
}

/// Sorts the pieces into closed ones, holes to fill and loose sheets to drop.
bool close_pieces(Work& work) {
    const Components parts = components(work.mesh);
    const std::vector<Piece> pieces = pieces_of(work.mesh, parts);
    double area = 0;
    std::vector<bool> closed(parts.count);
    for (std::size_t p = 0; p < parts.count; ++p) {
        area += pieces[p].area_mm2;
        closed[p] = pieces[p].border_edges == 0;
    }
    mesh::TriMesh out = extract(work.mesh, parts, closed);
    std::vector<std::size_t> loose;
    for (std::size_t p = 0; p < parts.count; ++p) {
        if (closed[p]) {
            continue;
        }
        std::optional<mesh::TriMesh> filled;
        if (pieces[p].may_be_filled(work.options.largest_hole_share)) {
            std::vector<bool> wanted(parts.count, false);
            wanted[p] = true;
            filled = filled_piece(work, extract(work.mesh, parts, wanted));
        }
        if (filled) {
            append(out, *filled);
        } else {
            loose.push_back(p);
        }
    }
    std::size_t sheets = 0;
    double sheet_area = 0;
    for (const std::size_t p : loose) {
        ++sheets;
        sheet_area += pieces[p].area_mm2;
    }
    if (sheet_area > kLargestSheetShare * area) {
        return work.needs_wrap("the surface is open: " + counted(sheets, "sheet") + " with " +
                               percent(sheet_area, area) + " of its area bound nothing");
    }
    if (sheets > 0) {
        work.surface_moved = true;
        work.change(Status::Fixed, "removed " + counted(sheets, "loose sheet") + " of " +
                                       figure(sheet_area) + " mm^2 (" + percent(sheet_area, area) +
                                       " of the surface)");
    }
    work.mesh = std::move(out);
    return true;
}

}  // namespace

bool close_surface(Work& work) {
    mesh::TopologyReport topology = mesh::check_topology(work.mesh);
    if (!topology.manifold()) {
        if (topology.border_edges > 0) {
            merge_near(work);
        }
        orient_and_split(work);
        topology = mesh::check_topology(work.mesh);
        if (topology.non_manifold_edges + topology.misoriented_edges +
                topology.non_manifold_vertices >
            0) {
            return work.needs_wrap("the surface has one side only, or more than two");
        }
        if (topology.border_edges > 0 && !close_pieces(work)) {
            return false;
        }
    }
    const Result<std::size_t> slivers = remove_slivers(work.mesh);
    if (!slivers) {
        return work.needs_wrap(slivers.error().message);
    }
    if (*slivers > 0) {
        work.change(Status::Fixed, "removed " + counted(*slivers, "triangle") + " without area");
    }
    return mesh::check_topology(work.mesh).manifold() ||
           work.needs_wrap("the surface could not be closed");
}

}  // namespace decomp::repair
