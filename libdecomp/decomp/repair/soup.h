// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <cstdint>
#include <vector>

/// Steps of the repair that need indices only; each returns how many things it changed.
namespace decomp::repair {

/// For each point the lowest index among the points with equal coordinates.
[[nodiscard]] std::vector<std::uint32_t> first_of_equal_points(const mesh::TriMesh& mesh);

/// Merges points with equal coordinates and drops unused ones. Returns the number of points merged.
std::size_t weld(mesh::TriMesh& mesh);

/// Removes triangles that repeat a corner.
std::size_t drop_degenerate(mesh::TriMesh& mesh);

/// Of triangles over the same three corners: pairs of opposite sense are an inner wall and vanish
/// both; of those left in one sense one stays.
struct DroppedDuplicates {
    std::size_t copies = 0;      ///< triangles removed because another of the same sense stays
    std::size_t wall_pairs = 0;  ///< pairs of opposite triangles removed
};

DroppedDuplicates drop_duplicates(mesh::TriMesh& mesh);

/// Turns triangles so that neighbours agree, starting from the lowest index of each component and
/// keeping the sense of its majority. Only edges with exactly two triangles carry the sense across.
/// Returns the number of turned triangles.
std::size_t orient_consistently(mesh::TriMesh& mesh);

/// Cuts the surface apart where more than two triangles meet at an edge, pairing neighbours around
/// it so that each pair encloses solid, and at points where several umbrellas meet; points are
/// doubled. Returns the number of new points.
std::size_t split_non_manifold(mesh::TriMesh& mesh);

/// Merges points on the border that lie closer together than reach_mm and than 0.3 of their
/// shortest border edge; the one of lower index stays. Undone unless it leaves fewer border edges
/// and no new edge with three triangles.
struct NearMerge {
    std::size_t points = 0;
    double farthest_mm = 0;
};

NearMerge merge_near_border(mesh::TriMesh& mesh, double reach_mm);

/// Component number of each triangle (by shared edges, numbered by lowest triangle) and their
/// count.
struct Components {
    std::vector<std::uint32_t> of_triangle;
    std::size_t count = 0;
};

[[nodiscard]] Components components(const mesh::TriMesh& mesh);

/// The triangles of one component, or of several, with their own points.
[[nodiscard]] mesh::TriMesh extract(const mesh::TriMesh& mesh, const Components& parts,
                                    const std::vector<bool>& wanted);

/// Adds the triangles of another mesh, with its points.
void append(mesh::TriMesh& mesh, const mesh::TriMesh& more);

/// Swaps two corners of every triangle.
void flip(mesh::TriMesh& mesh);

}  // namespace decomp::repair
