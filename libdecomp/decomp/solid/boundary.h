// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/solid/regions.h"
#include "decomp/solid/solid.h"

#include <cstdint>
#include <vector>

namespace decomp::solid {

/// The mesh as faces, before it is a solid: which triangle belongs to which face, and where three
/// faces meet.
struct FaceMap {
    std::vector<std::int32_t> of;         ///< face of each triangle, dense, by first triangle
    std::vector<std::int32_t> region;     ///< of each face; -1: a triangle alone
    std::vector<std::uint32_t> triangle;  ///< first triangle of each face
    std::vector<bool> corner;             ///< for each point: is it a vertex of the solid?
};

[[nodiscard]] FaceMap map_faces(const mesh::TriMesh& mesh, const Adjacency& adjacency,
                                const Regions& regions);

/// Moves the corners onto the surfaces that meet there, each by the shortest way, and gives the
/// surface of every face. Regions that ask for too much (a move beyond the tolerance, or surfaces
/// without a common point) are listed in `refused`.
struct Settled {
    std::vector<Eigen::Vector3d> points;  ///< of the mesh; corners moved
    std::vector<Surface> surfaces;        ///< of each face
    std::vector<std::int32_t> refused;    ///< regions, sorted
    double farthest_mm = 0;               ///< moved by a corner
    double off_mm = 0;                    ///< left between a corner and its surfaces
};

[[nodiscard]] Settled settle(const mesh::TriMesh& mesh, const Regions& regions,
                             const FaceMap& faces, double tolerance_mm);

/// Edges, loops and seams. Regions whose boundary no line, circle or ellipse can describe are
/// listed in `refused`, and the solid is then unfinished.
struct Bounded {
    Solid solid;
    std::vector<std::int32_t> refused;
};

[[nodiscard]] Bounded bound(const mesh::TriMesh& mesh, const Adjacency& adjacency,
                            const Regions& regions, const FaceMap& faces, const Settled& settled);

/// Gives a face that goes round its axis a seam: an edge along the axis between its two rims, where
/// nothing lies in the way. False where there is no such place.
/// @param walk for each loop of the face the mesh points that it passes, in its sense
/// @param round how often each loop goes round the axis: -1, 0, 1
[[nodiscard]] bool add_seam(Solid& solid, std::int32_t face,
                            const std::vector<std::vector<Eigen::Vector3d>>& walk,
                            const std::vector<int>& round);

/// Gives a face that goes round the apex of its cone an edge from its rim to there. False where
/// something lies in the way, or the surface is no cone.
[[nodiscard]] bool add_apex(Solid& solid, std::int32_t face,
                            const std::vector<std::vector<Eigen::Vector3d>>& walk,
                            const std::vector<int>& round);

struct AxisLine {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
};

/// The axis of a curved surface.
[[nodiscard]] AxisLine axis_of(const Surface& surface);

/// Signed angle of p about the axis of a curved surface.
[[nodiscard]] double angle_about(const Surface& surface, const Eigen::Vector3d& p);

/// The difference of two angles, within (-pi, pi].
[[nodiscard]] double turn_between(double from, double to);

}  // namespace decomp::solid
