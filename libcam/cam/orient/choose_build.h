// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"
#include "cam/profile/read_profile.h"
#include "decomp/base/frame.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/judge.h"
#include "decomp/part/part.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace cam::orient {

/// One way to stand a part on the plate.
struct BuildChoice {
    decomp::Pose<decomp::PartBedFrame, decomp::ModelFrame> pose;
    double support_area_mm2 =
        0;  ///< surface flatter than the support angle, facing down, above the base
    double footprint_mm2 = 0;  ///< convex hull of the part's shadow on the plate
    double base_mm2 = 0;       ///< area that touches the plate
    int base_plane =
        -1;  ///< cut plane (index in Assembly::planes); -1: a flat of the input, or an axis
    bool on_cut_face = false;
    bool on_flat = false;  ///< false: stands on the end of a model axis
    bool stable = false;   ///< the centre of mass is above the hull of the base
    Eigen::Vector3d size_mm = Eigen::Vector3d::Zero();  ///< bounding box of the posed part
    std::vector<decomp::part::Violation> violations;    ///< "chamber.x", "chamber.y", "chamber.z"

    [[nodiscard]] bool fits() const { return violations.empty(); }
};

/// Free border that a part needs around its footprint: whole loops of brim, or the skirt with its
/// distance.
[[nodiscard]] double border_mm(const profile::FdmMachine& machine);

/// What a part may measure in X, Y (footprint without border) and Z, once border, margin, lift and
/// the rounding to whole layers are taken off the chamber.
[[nodiscard]] Eigen::Vector3d usable_mm(const profile::FdmMachine& machine);

/// Everything of a machine on which rank_builds() and fdm_judge() depend: equal values, equal
/// builds. Whoever keeps a decomposition keeps these with it.
[[nodiscard]] std::array<double, 4> judged_values(const profile::FdmMachine& machine);

/// All poses worth a look, best first: those that fit, then stable ones, then flat faces before
/// axes, then the least support; ties by height, base area and order of discovery. Each is turned
/// about Z into the smallest rectangle that fits; an unturned one that is nearly as small is
/// preferred. Never empty for a part with triangles. O(n) per pose.
[[nodiscard]] std::vector<BuildChoice> rank_builds(const decomp::part::Part& part,
                                                   const profile::FdmMachine& machine);

/// The part as it is printed: facets that lie on the plate within 0.02 mm are exactly at z = 0, so
/// min z = 0. Whoever makes the printed mesh makes it here.
[[nodiscard]] decomp::mesh::TriMesh placed(
    const decomp::part::Part& part,
    const decomp::Pose<decomp::PartBedFrame, decomp::ModelFrame>& pose);
[[nodiscard]] decomp::mesh::TriMesh placed(const decomp::part::Part& part,
                                           const BuildChoice& choice);

/// The judge of one FDM job: the first of rank_builds(). cuts_that_help divide the violated extents
/// evenly, worst first. An Estimate is content with a cut face that fits, and does not look for
/// other flats then.
[[nodiscard]] decomp::part::Judge fdm_judge(const profile::FdmSetup& setup);

}  // namespace cam::orient
