// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/plane.h"

#include <array>
#include <cstdint>
#include <vector>

namespace decomp::sections {

/// Area A(t) of the cross-section normal . x = t and its topology, at one height.
struct Station {
    double t_mm = 0;
    double area_mm2 = 0;
    double slope_mm = 0;  ///< dA/dt
    std::int32_t outlines =
        0;  ///< closed curves with material inside: connected pieces of the section
    std::int32_t holes = 0;  ///< closed curves with material outside

    [[nodiscard]] std::int32_t euler_number() const { return outlines - holes; }
};

enum class EventKind : std::uint8_t {
    Neck,      ///< local minimum of A
    Jump,      ///< local maximum of |dA/dt|
    Topology,  ///< the number of outlines or holes changes
};

/// A height at which a shape wants to be cut.
struct Event {
    EventKind kind = EventKind::Neck;
    double t_mm = 0;
    double area_mm2 = 0;
    double strength = 0;  ///< 0..1: neck 1 - A / min of the maxima on both sides; jump: share of
                          ///< the largest |dA/dt|; topology: 1
};

/// Cross-sections along one direction. A is piecewise quadratic with knots at the vertices'
/// heights; area() evaluates the pieces exactly (to rounding), stations sample them.
class Profile {
  public:
    /// @param direction  unit length
    /// @param stations   samples between the lowest and the highest point
    /// Cost O(n + sections), about 5 ms for 70k triangles and 192 stations. The mesh must be closed
    /// and must outlive the profile.
    Profile(const mesh::TriMesh& mesh, const Eigen::Vector3d& direction, int stations = 192);

    [[nodiscard]] const Eigen::Vector3d& direction() const { return direction_; }

    [[nodiscard]] double low_mm() const { return low_; }

    [[nodiscard]] double high_mm() const { return high_; }

    [[nodiscard]] const std::vector<Station>& stations() const { return stations_; }

    /// Exact A(t) and dA/dt; cost O(triangles in one slab between stations).
    [[nodiscard]] Station at(double t_mm) const;

    /// Necks, jumps and topology changes, by rising height. Necks and jumps are refined between
    /// stations.
    [[nodiscard]] std::vector<Event> events() const;

  private:
    void sort_into_slabs();
    [[nodiscard]] std::size_t slab_of(double t_mm) const;
    [[nodiscard]] Station measure(double t_mm, bool with_topology) const;
    void add_necks(std::vector<Event>& events) const;
    void add_jumps(std::vector<Event>& events) const;
    void add_topology_changes(std::vector<Event>& events) const;

    const mesh::TriMesh* mesh_;
    Eigen::Vector3d direction_;
    double low_ = 0;
    double high_ = 0;
    std::vector<Eigen::Vector3d> points_;    // (u, v, t) of every point of the mesh
    std::vector<std::uint32_t> slab_begin_;  // CSR: triangles that reach into each slab
    std::vector<std::uint32_t> slab_triangles_;
    std::vector<Station> stations_;
};

/// Two unit vectors u, v so that u, v, direction are right-handed; a fixed function of the
/// direction.
[[nodiscard]] std::array<Eigen::Vector3d, 2> plane_basis(const Eigen::Vector3d& direction);

/// Area of one plane section. O(n).
[[nodiscard]] double section_area(const mesh::TriMesh& mesh, const part::Plane& plane);

/// Directions in which to look for cuts: model axes, principal axes, normals of large flats; the
/// opposite of one already listed is left out. Model axes first.
[[nodiscard]] std::vector<Eigen::Vector3d> directions(const mesh::TriMesh& mesh);

struct NeckSearch {
    double max_tilt = 0.5;  ///< radians that the normal may turn in all
    double max_shift_mm =
        0;            ///< that the plane may move along its normal, at the centre of its section
    int rounds = 12;  ///< the steps halve in each
};

/// Turns and shifts the plane to a local minimum of its section's area (pattern search; counted,
/// not timed).
[[nodiscard]] part::Plane refined_neck(const mesh::TriMesh& mesh, const part::Plane& start,
                                       const NeckSearch& search);

}  // namespace decomp::sections
