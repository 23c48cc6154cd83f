// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/orient/choose_build.h"

#include "cam/orient/candidates.h"
#include "cam/orient/footprint.h"
#include "cam/orient/overhang.h"
#include "decomp/mesh/facets.h"
#include "decomp/mesh/measure.h"
#include "decomp/mesh/moments.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>

namespace cam::orient {

namespace {

using decomp::ModelFrame;
using decomp::PartBedFrame;
using decomp::Pose;
using decomp::mesh::Triangle;
using decomp::mesh::TriMesh;
using decomp::part::Fidelity;
using decomp::part::Part;
using decomp::part::Plane;
using decomp::part::Verdict;
using decomp::part::Violation;

constexpr double kLevel = 0.9999;       // cosine: facets this level belong to a base
constexpr double kSameSupport = 1e-6;   // of the surface
constexpr double kExactlyFull = 1e-12;  // relative room for rounding
constexpr double kDownward = 1e-12;     // a unit vector so near to -Z is it
constexpr double kWholeNumber = 1e-9;   // a quotient so little above a whole number is it
constexpr double kLeastRoomMm = 1e-9;   // keeps quotients finite when margins eat the plate
constexpr std::array<const char*, 3> kConstraints{"chamber.x", "chamber.y", "chamber.z"};

/// What all poses of one part share.
struct Surface {
    const TriMesh* mesh = nullptr;
    std::vector<std::uint32_t> used;  // points of triangles
    decomp::mesh::Facets facets;
    Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();
};

Surface surface_of(const TriMesh& mesh) {
    Surface out;
    out.mesh = &mesh;
    std::vector<bool> is_used(mesh.points.size(), false);
    out.facets = decomp::mesh::measure_facets(mesh);
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t) {
            is_used[v] = true;
        }
    }
    for (std::uint32_t v = 0; v < is_used.size(); ++v) {
        if (is_used[v]) {
            out.used.push_back(v);
        }
    }
    out.centre_of_mass = decomp::mesh::moments(mesh).centre;
    return out;
}

/// The rotation that turns `down` to -Z by the shortest way; exact for the axes.
Eigen::Matrix3d standing_on(const Eigen::Vector3d& down) {
    const Eigen::Vector3d z = -down;
    if (z == Eigen::Vector3d::UnitZ()) {
        return Eigen::Matrix3d::Identity();
    }
    if (z.z() < -1 + kDownward) {
        return Eigen::Vector3d(1, -1, -1).asDiagonal();  // half a turn about X
    }
    // Rodrigues for the rotation of z to (0, 0, 1) about z x e3.
    const Eigen::Vector3d axis = z.cross(Eigen::Vector3d::UnitZ());
    Eigen::Matrix3d k;
    k << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
    return Eigen::Matrix3d::Identity() + k + k * k / (1 + z.z());
}

Eigen::Matrix3d turn_about_z(double angle) {
    const bool quarter = angle == std::numbers::pi / 2;
    const double c = quarter ? 0 : std::cos(angle);
    const double s = quarter ? 1 : std::sin(angle);
    Eigen::Matrix3d out;
    out << c, s, 0, -s, c, 0, 0, 0, 1;  // by -angle
    return out;
}

std::vector<Violation> violations_of(const Eigen::Vector3d& size, const Eigen::Vector3d& usable) {
    std::vector<Violation> out;
    for (int axis = 0; axis < 3; ++axis) {
        const double ratio =
            usable[axis] > 0 ? size[axis] / usable[axis] : std::numeric_limits<double>::infinity();
        if (ratio > 1 + kExactlyFull) {
            out.push_back({kConstraints.at(static_cast<std::size_t>(axis)), ratio});
        }
    }
    return out;
}

BuildChoice build_on(const Surface& surface, const Stand& stand,
                     const profile::FdmMachine& machine) {
    BuildChoice choice;
    choice.base_plane = stand.plane;
    choice.on_cut_face = stand.on_cut_face;
    choice.on_flat = stand.on_flat;
    const Eigen::Matrix3d standing = standing_on(stand.down);
    std::vector<Eigen::Vector3d> points(surface.mesh->points.size());
    double floor = std::numeric_limits<double>::infinity();
    double top = -floor;
    for (const std::uint32_t v : surface.used) {
        points[v] = standing * surface.mesh->points[v];
        floor = std::min(floor, points[v].z());
        top = std::max(top, points[v].z());
    }
    std::vector<Eigen::Vector2d> shadow;
    std::vector<Eigen::Vector2d> contact;
    shadow.reserve(surface.used.size());
    for (const std::uint32_t v : surface.used) {
        points[v].z() -= floor;
        shadow.emplace_back(points[v].head<2>());
        if (points[v].z() <= kOnPlateMm) {
            contact.emplace_back(points[v].head<2>());
        }
    }
    const Eigen::Vector3d usable = usable_mm(machine);
    const std::vector<Eigen::Vector2d> hull = convex_hull(shadow);
    const Turned turned = best_turn(hull, usable.head<2>().cwiseMax(kLeastRoomMm));
    const std::vector<Eigen::Vector2d> base_hull = convex_hull(contact);
    choice.footprint_mm2 = polygon_area(hull);
    choice.size_mm = {turned.size.x(), turned.size.y(), top - floor};
    choice.violations = violations_of(choice.size_mm, usable);
    choice.stable = holds(base_hull, (standing * surface.centre_of_mass).head<2>());
    const Overhang overhang =
        find_overhang(*surface.mesh, surface.facets, stand.down, machine.process.support_angle);
    choice.support_area_mm2 = overhang.overhang_mm2;
    choice.base_mm2 = overhang.base_mm2;
    Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
    map.linear() = turn_about_z(turned.angle) * standing;
    Eigen::AlignedBox3d box;
    for (const std::uint32_t v : surface.used) {
        box.extend(Eigen::Vector3d(map.linear() * surface.mesh->points[v]));
    }
    map.translation() = Eigen::Vector3d(-box.center().x(), -box.center().y(), -box.min().z());
    choice.pose = Pose<PartBedFrame, ModelFrame>(map);
    return choice;
}

/// How many chambers a misfit fills, roughly: what a search should bring down.
double chambers(const BuildChoice& choice) {
    double product = 1;
    for (const Violation& violation : choice.violations) {
        product *= std::ceil(violation.by_ratio - kWholeNumber);
    }
    return product;
}

double worst_ratio(const BuildChoice& choice) {
    double worst = 0;
    for (const Violation& violation : choice.violations) {
        worst = std::max(worst, violation.by_ratio);
    }
    return worst;
}

bool better(const BuildChoice& a, const BuildChoice& b, double same_support) {
    if (a.fits() != b.fits()) {
        return a.fits();
    }
    if (!a.fits()) {
        if (chambers(a) != chambers(b)) {
            return chambers(a) < chambers(b);
        }
        return worst_ratio(a) < worst_ratio(b);
    }
    if (a.stable != b.stable) {
        return a.stable;
    }
    if (a.on_flat != b.on_flat) {
        return a.on_flat;
    }
    // Areas on a grid, so that the order is a strict weak one.
    const double grid = std::max(same_support, std::numeric_limits<double>::min());
    const double support_a = std::round(a.support_area_mm2 / grid);
    const double support_b = std::round(b.support_area_mm2 / grid);
    if (support_a != support_b) {
        return support_a < support_b;
    }
    const double height_a = std::round(a.size_mm.z() / kOnPlateMm);
    const double height_b = std::round(b.size_mm.z() / kOnPlateMm);
    if (height_a != height_b) {
        return height_a < height_b;
    }
    return std::round(a.base_mm2 / grid) > std::round(b.base_mm2 / grid);
}

/// Planes that divide each violated extent into equal slabs, in the model frame; worst extent
/// first, middle first.
std::vector<Plane> dividing_planes(const BuildChoice& choice) {
    std::vector<Violation> violations = choice.violations;
    std::stable_sort(
        violations.begin(), violations.end(),
        [](const Violation& a, const Violation& b) { return a.by_ratio > b.by_ratio; });
    std::vector<Plane> planes;
    for (const Violation& violation : violations) {
        const auto axis = static_cast<int>(
            std::find(kConstraints.begin(), kConstraints.end(), violation.constraint) -
            kConstraints.begin());
        const int slabs = static_cast<int>(std::min(64.0, std::ceil(violation.by_ratio)));
        std::vector<int> order;
        for (int i = 1; i < slabs; ++i) {
            order.push_back(i);
        }
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
            return std::abs(2 * a - slabs) < std::abs(2 * b - slabs);
        });
        const Eigen::Isometry3d& map = choice.pose.map();
        const double low = axis == 2 ? 0 : -choice.size_mm[axis] / 2;
        for (const int i : order) {
            Plane plane;
            plane.normal = map.linear().row(axis).transpose();
            plane.offset_mm = low + choice.size_mm[axis] * i / slabs - map.translation()[axis];
            planes.push_back(plane);
        }
    }
    return planes;
}

std::vector<BuildChoice> ranked(const Part& part, const profile::FdmMachine& machine, Flats flats) {
    std::vector<BuildChoice> choices;
    if (part.mesh.triangles.empty()) {
        return choices;
    }
    const Surface surface = surface_of(part.mesh);
    for (const Stand& stand : stands(part, flats)) {
        choices.push_back(build_on(surface, stand, machine));
    }
    const double same_support = kSameSupport * surface.facets.total_mm2;
    std::stable_sort(
        choices.begin(), choices.end(),
        [&](const BuildChoice& a, const BuildChoice& b) { return better(a, b, same_support); });
    return choices;
}

}  // namespace

double border_mm(const profile::FdmMachine& machine) {
    const auto& process = machine.process;
    const double line = process.first_layer_line_width_mm;
    if (process.brim_width_mm > 0) {
        return std::ceil(process.brim_width_mm / line - kWholeNumber) * line;
    }
    return process.skirt_loops > 0 ? process.skirt_distance_mm + process.skirt_loops * line : 0;
}

Eigen::Vector3d usable_mm(const profile::FdmMachine& machine) {
    const auto& chamber = machine.chamber;
    Eigen::Vector3d usable = chamber.max_mm - chamber.min_mm;
    usable.z() = chamber.max_mm.z() - std::max(0.0, chamber.min_mm.z());
    usable.head<2>().array() -= 2 * (chamber.margin_mm + border_mm(machine));
    // The last layer may end up to one layer above the part, and a lifted travel may follow it.
    usable.z() -= chamber.margin_mm + machine.retraction.lift_mm + machine.process.layer_height_mm;
    return usable;
}

std::array<double, 4> judged_values(const profile::FdmMachine& machine) {
    const Eigen::Vector3d usable = usable_mm(machine);
    return {usable.x(), usable.y(), usable.z(), machine.process.support_angle.radians()};
}

std::vector<BuildChoice> rank_builds(const Part& part, const profile::FdmMachine& machine) {
    return ranked(part, machine, Flats::Sought);
}

TriMesh placed(const Part& part, const Pose<PartBedFrame, ModelFrame>& pose) {
    TriMesh out = decomp::mesh::transformed(part.mesh, Eigen::Affine3d(pose.map().matrix()));
    for (std::size_t i = 0; i < out.triangles.size(); ++i) {
        const Triangle& t = out.triangles[i];
        const Eigen::Vector3d normal = decomp::mesh::double_area_normal(out, i);
        const bool low = std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
            return std::abs(out.points[v].z()) <= kOnPlateMm;
        });
        if (low && -normal.z() > kLevel * normal.norm()) {
            for (const std::uint32_t v : t) {
                out.points[v].z() = 0;
            }
        }
    }
    double floor = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& point : out.points) {
        floor = std::min(floor, point.z());
    }
    for (Eigen::Vector3d& point : out.points) {
        // Below the base only by rounding; without a base the lowest point is the base.
        point.z() = floor > 0 ? point.z() - floor : std::max(0.0, point.z());
    }
    return out;
}

TriMesh placed(const Part& part, const BuildChoice& choice) { return placed(part, choice.pose); }

decomp::part::Judge fdm_judge(const profile::FdmSetup& setup) {
    return [machine = setup.machine](const Part& part, Fidelity fidelity) {
        Verdict verdict;
        const Flats flats = fidelity == Fidelity::Estimate ? Flats::Left : Flats::Sought;
        std::vector<BuildChoice> choices = ranked(part, machine, flats);
        if (flats == Flats::Left && !choices.empty() && !choices.front().fits()) {
            choices = ranked(part, machine, Flats::Sought);
        }
        if (choices.empty()) {
            return verdict;
        }
        const BuildChoice& best = choices.front();
        verdict.best_pose = best.pose;
        verdict.violations = best.violations;
        verdict.support_area_mm2 = best.support_area_mm2;
        verdict.stable = best.stable;
        verdict.cuts_that_help = dividing_planes(best);
        return verdict;
    };
}

}  // namespace cam::orient
