// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/hanging.h"
#include "cam/check/share.h"
#include "cam/orient/overhang.h"
#include "cam/profile/fdm_machine.h"
#include "decomp/base/units.h"
#include "decomp/part/part.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace cam::check {

struct FdmOptions {
    decomp::Angle support_angle = decomp::Angle::degrees(45);  ///< see orient::find_overhang()
    double on_plate_mm = orient::kOnPlateMm;  ///< what lies no higher lies on the plate
    HangingOptions hanging;
};

/// What a printer's profile says of it.
[[nodiscard]] FdmOptions fdm_options(const profile::FdmMachine& machine);

/// One part in one pose. `overhang` is the paper's reading: normals only, the base excluded;
/// `support` the truer one: what has to be carried, bridges taken off.
struct FdmPose {
    Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();  ///< outward normal of the base
    int plane = -1;                                    ///< cut plane of the base, or -1
    bool on_cut_face = false;
    bool on_flat = false;  ///< false: the end of an axis
    Share overhang;
    Share support;  ///< overhang without bridges
    Share bridges;
    Share islands;  ///< of the support, what begins in the air
    Share plate;    ///< excluded: it lies on the plate
};

struct FdmCheck {
    std::vector<FdmPose> poses;      ///< every flat face as base; the ends of the model axes for an
                                     ///< uncut part
    std::size_t best = 0;            ///< least support by area
    std::size_t best_by_normal = 0;  ///< least overhang by area: %3DPPS of the paper
    std::size_t best_by_facets = 0;  ///< least overhang by number of facets
};

/// All flat faces of a part tried as base; ties go to cut faces, then to the order of
/// orient::stands(). Empty for a part without triangles. O(n log n) a pose.
[[nodiscard]] FdmCheck check_fdm(const decomp::part::Part& part, const FdmOptions& options);

/// One mesh with `down` to the plate. `neighbours` as decomp::mesh::neighbours() gives them.
[[nodiscard]] FdmPose check_pose(const decomp::mesh::TriMesh& mesh,
                                 const decomp::mesh::Facets& facets,
                                 const std::vector<std::array<std::int32_t, 3>>& neighbours,
                                 const Eigen::Vector3d& down, const FdmOptions& options);

/// A whole model standing on the end of each axis: down is -z, z, -x, x, -y, y. %3DPST of the paper
/// is overhang.by_area_percent.
[[nodiscard]] std::array<FdmPose, 6> check_axes(const decomp::mesh::TriMesh& mesh,
                                                const FdmOptions& options);

/// What each facet is in one pose, for pictures.
[[nodiscard]] std::vector<Hanging> hanging_in(const decomp::mesh::TriMesh& mesh,
                                              const Eigen::Vector3d& down,
                                              const FdmOptions& options);

}  // namespace cam::check
