// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/fdm.h"

#include "cam/orient/candidates.h"
#include "cam/orient/overhang.h"

#include <algorithm>

namespace cam::check {

using decomp::mesh::Facets;
using decomp::mesh::TriMesh;

namespace {

constexpr double kSameShare = 1e-9;  // of the surface: not worth a choice

/// The first pose with the least value.
template <class Value>
std::size_t least(const std::vector<FdmPose>& poses, Value value) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        if (value(poses[i]) < value(poses[best]) - kSameShare) {
            best = i;
        }
    }
    return best;
}

}  // namespace

FdmOptions fdm_options(const profile::FdmMachine& machine) {
    FdmOptions options;
    options.support_angle = machine.process.support_angle;
    options.hanging.longest_bridge_mm = machine.process.longest_bridge_mm;
    options.hanging.layer_height_mm = machine.process.layer_height_mm;
    return options;
}

FdmPose check_pose(const TriMesh& mesh, const Facets& facets,
                   const std::vector<std::array<std::int32_t, 3>>& neighbours,
                   const Eigen::Vector3d& down, const FdmOptions& options) {
    FdmPose pose;
    pose.down = down;
    const orient::Overhang overhang =
        orient::find_overhang(mesh, facets, down, options.support_angle, options.on_plate_mm);
    const std::vector<Hanging> kind =
        classify_hanging(mesh, facets, neighbours, overhang, down, options.hanging);
    const auto share = [&](auto belongs) {
        return share_of(facets, [&](std::size_t i) { return belongs(kind[i]); });
    };
    pose.overhang = share([](Hanging k) {
        return k == Hanging::Overhang || k == Hanging::Bridge || k == Hanging::Island;
    });
    pose.support = share([](Hanging k) { return k == Hanging::Overhang || k == Hanging::Island; });
    pose.bridges = share([](Hanging k) { return k == Hanging::Bridge; });
    pose.islands = share([](Hanging k) { return k == Hanging::Island; });
    pose.plate = share([](Hanging k) { return k == Hanging::Plate; });
    return pose;
}

FdmCheck check_fdm(const decomp::part::Part& part, const FdmOptions& options) {
    FdmCheck out;
    const Facets facets = decomp::mesh::measure_facets(part.mesh);
    const auto neighbours = decomp::mesh::neighbours(part.mesh);
    for (const orient::Stand& stand : orient::stands(part, orient::Flats::Sought)) {
        FdmPose pose = check_pose(part.mesh, facets, neighbours, stand.down, options);
        pose.plane = stand.plane;
        pose.on_cut_face = stand.on_cut_face;
        pose.on_flat = stand.on_flat;
        out.poses.push_back(pose);
    }
    // An end of an axis is no base where there is a flat one.
    if (std::any_of(out.poses.begin(), out.poses.end(),
                    [](const FdmPose& pose) { return pose.on_flat; })) {
        std::erase_if(out.poses, [](const FdmPose& pose) { return !pose.on_flat; });
    }
    out.best = least(out.poses, [](const FdmPose& p) { return p.support.by_area_percent; });
    out.best_by_normal =
        least(out.poses, [](const FdmPose& p) { return p.overhang.by_area_percent; });
    out.best_by_facets =
        least(out.poses, [](const FdmPose& p) { return p.overhang.by_facets_percent; });
    return out;
}

std::array<FdmPose, 6> check_axes(const TriMesh& mesh, const FdmOptions& options) {
    const Facets facets = decomp::mesh::measure_facets(mesh);
    const auto neighbours = decomp::mesh::neighbours(mesh);
    std::array<FdmPose, 6> out;
    std::size_t next = 0;
    for (const int axis : {2, 0, 1}) {
        for (const double sign : {-1.0, 1.0}) {
            out.at(next++) =
                check_pose(mesh, facets, neighbours, sign * Eigen::Vector3d::Unit(axis), options);
        }
    }
    return out;
}

std::vector<Hanging> hanging_in(const TriMesh& mesh, const Eigen::Vector3d& down,
                                const FdmOptions& options) {
    const Facets facets = decomp::mesh::measure_facets(mesh);
    return classify_hanging(
        mesh, facets, decomp::mesh::neighbours(mesh),
        orient::find_overhang(mesh, facets, down, options.support_angle, options.on_plate_mm), down,
        options.hanging);
}

}  // namespace cam::check
