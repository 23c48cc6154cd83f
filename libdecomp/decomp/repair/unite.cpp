// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/unite.h"

#include "decomp/mesh/measure.h"
#include "decomp/repair/boolean.h"
#include "decomp/repair/edges.h"
#include "decomp/repair/intersect.h"
#include "decomp/repair/shells.h"
#include "decomp/repair/soup.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace decomp::repair {

namespace {

constexpr std::size_t kMostCrossings = 10'000'000;  // pairs; far beyond any real assembly

/// Shells by group: those that cross each other, directly or through others.
std::vector<std::vector<std::uint32_t>> crossing_groups(const mesh::TriMesh& mesh,
                                                        const Components& parts) {
    Sets sets(parts.count);
    for (const auto& [a, b] : self_intersections(mesh, kMostCrossings)) {
        sets.unite(parts.of_triangle[a], parts.of_triangle[b]);
    }
    std::vector<std::vector<std::uint32_t>> members(parts.count);
    for (std::uint32_t shell = 0; shell < parts.count; ++shell) {
        members[sets.find(shell)].push_back(shell);
    }
    std::erase_if(members, [](const auto& group) { return group.size() < 2; });
    return members;
}

mesh::TriMesh shell_alone(const mesh::TriMesh& mesh, const Components& parts, std::uint32_t shell) {
    std::vector<bool> wanted(parts.count, false);
    wanted[shell] = true;
    return extract(mesh, parts, wanted);
}

/// One group on its way to its union.
struct Group {
    std::vector<mesh::TriMesh> outward;
    std::vector<mesh::TriMesh> inward;  ///< turned outward
};

Group sort_by_sense(const mesh::TriMesh& mesh, const Components& parts,
                    const std::vector<std::uint32_t>& members) {
    Group group;
    for (const std::uint32_t member : members) {
        mesh::TriMesh shell = shell_alone(mesh, parts, member);
        if (mesh::volume_mm3(shell) < 0) {
            flip(shell);
            group.inward.push_back(std::move(shell));
        } else {
            group.outward.push_back(std::move(shell));
        }
    }
    return group;
}

double largest_volume(const std::vector<mesh::TriMesh>& shells) {
    double largest = 0;
    for (const auto& shell : shells) {
        largest = std::max(largest, mesh::volume_mm3(shell));
    }
    return largest;
}

bool lies_within(const mesh::TriMesh& inner, const mesh::TriMesh& others) {
    return !others.triangles.empty() && std::abs(winding_number(others, inner.points[0])) > 0.5;
}

}  // namespace

Result<UnitedShells> unite_shells(mesh::TriMesh& mesh, const Run& run) {
    const Components parts = components(mesh);
    const auto groups = crossing_groups(mesh, parts);
    UnitedShells done;
    std::vector<bool> untouched(parts.count, true);
    for (const auto& members : groups) {
        for (const std::uint32_t member : members) {
            untouched[member] = false;
        }
    }
    mesh::TriMesh out = extract(mesh, parts, untouched);
    const mesh::TriMesh others = out;
    for (const auto& members : groups) {
        Group group = sort_by_sense(mesh, parts, members);
        // A group of cavities stays inward; one that is inside out as a whole is turned.
        const bool inward_leads = largest_volume(group.inward) > largest_volume(group.outward);
        const bool cavity = inward_leads && lies_within(group.inward.front(), others);
        if (inward_leads) {
            std::swap(group.inward, group.outward);
        }
        Result<BooleanResult> united = exact_boolean(group.outward, group.inward, run);
        if (!united) {
            return fail(united.error());
        }
        if (cavity) {
            flip(united->mesh);
        }
        append(out, united->mesh);
        done.shrunk_mm = std::max(done.shrunk_mm, united->shrunk_mm);
        ++done.groups;
        done.shells += members.size();
        done.subtracted += group.inward.size();
    }
    mesh = std::move(out);
    return done;
}

}  // namespace decomp::repair
