// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <variant>
#include <vector>

/// A solid by its boundary: faces on surfaces, bounded by loops of shared edges. A value;
/// millimetres.
namespace decomp::solid {

/// normal . x = offset_mm; the unit normal points out of the solid.
struct PlaneSurface {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    double offset_mm = 0;
};

struct CylinderSurface {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< on the axis
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();   ///< unit
    double radius_mm = 0;
};

struct ConeSurface {
    Eigen::Vector3d apex = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, from the apex into the cone
    double half_angle = 0;                            ///< radians
};

/// The tube's circle of radius `minor_mm` goes round the axis at `major_mm` from it.
struct TorusSurface {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit
    double major_mm = 0;                              ///< more than minor_mm
    double minor_mm = 0;
};

using Surface = std::variant<PlaneSurface, CylinderSurface, ConeSurface, TorusSurface>;

/// x(t) = origin + t * direction
struct LineCurve {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit
};

/// x(t) = centre + cos t * major + sin t * minor; a circle where both are of one length. `minor` is
/// perpendicular to `major` and never longer.
struct EllipseCurve {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Vector3d major = Eigen::Vector3d::UnitX();
    Eigen::Vector3d minor = Eigen::Vector3d::UnitY();
    bool circle = true;
};

using Curve = std::variant<LineCurve, EllipseCurve>;

/// Runs from vertex `from` at parameter t0 to vertex `to` at t1 > t0; a closed edge has both in
/// one.
struct Edge {
    Curve curve;
    std::int32_t from = -1;
    std::int32_t to = -1;
    double t0 = 0;
    double t1 = 0;
};

struct EdgeUse {
    std::int32_t edge = -1;
    bool reversed = false;
};

/// Closed, the face on its left seen from outside the solid.
using Loop = std::vector<EdgeUse>;

struct Face {
    Surface surface;
    bool outward =
        true;  ///< the surface's own normal (away from its axis or tube) leaves the solid
    std::vector<Loop> loops;  ///< the outer one first; a face that goes round its axis has one loop
                              ///< that runs along its seam twice
};

struct Solid {
    std::vector<Eigen::Vector3d> vertices;
    std::vector<Edge> edges;  ///< each used twice, once either way
    std::vector<Face> faces;
    std::vector<std::vector<std::int32_t>> shells;  ///< faces of each closed surface
    std::vector<std::int32_t>
        cavity_of;               ///< for each shell: the shell that holds it; -1: an outer one
    double tolerance_mm = 1e-7;  ///< vertices lie on their surfaces within this
};

/// The solid moved rigidly.
[[nodiscard]] Solid moved(Solid solid, const Eigen::Isometry3d& motion);

[[nodiscard]] Eigen::Vector3d point_at(const Curve& curve, double t);

/// The parameter of the point nearest to p; of an ellipse within (-pi, pi].
[[nodiscard]] double parameter_of(const Curve& curve, const Eigen::Vector3d& p);

/// Signed distance, positive away from the axis or tube, or along the normal.
[[nodiscard]] double distance_mm(const Surface& surface, const Eigen::Vector3d& p);

/// Unit gradient of distance_mm().
[[nodiscard]] Eigen::Vector3d normal_at(const Surface& surface, const Eigen::Vector3d& p);

/// A unit vector perpendicular to `axis`, always the same for the same axis; angles about an axis
/// are counted from it.
[[nodiscard]] Eigen::Vector3d reference_direction(const Eigen::Vector3d& axis);

}  // namespace decomp::solid
