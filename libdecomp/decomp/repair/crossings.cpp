// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/distance.h"
#include "decomp/repair/holes.h"
#include "decomp/repair/intersect.h"
#include "decomp/repair/resolve.h"
#include "decomp/repair/soup.h"
#include "decomp/repair/unite.h"
#include "decomp/repair/untangle.h"
#include "decomp/repair/work.h"

#include <algorithm>

namespace decomp::repair {

namespace {

constexpr std::size_t kFewCrossings = 400;         // pairs that are mended locally
constexpr std::size_t kMostCrossings = 2'000'000;  // pairs beyond which nobody counts
// Two sheets cross along a line, in few pairs for their size; a tangle of many sheets, which exact
// cutting would chew for minutes, shows in more pairs than half the triangles.
constexpr std::size_t kAlwaysCut = 50;
constexpr double kLargestMendedShift = 0.01;   // of the diagonal
constexpr double kLargestMendedVolume = 0.01;  // of the volume

struct Crossings {
    std::size_t within = 0;   ///< pairs of triangles of one shell
    std::size_t between = 0;  ///< pairs of different shells
};

Crossings count_crossings(const mesh::TriMesh& mesh) {
    Crossings count;
    const auto pairs = self_intersections(mesh, kMostCrossings);
    if (pairs.empty()) {
        return count;
    }
    const Components parts = components(mesh);
    for (const auto& [a, b] : pairs) {
        ++(parts.of_triangle[a] == parts.of_triangle[b] ? count.within : count.between);
    }
    return count;
}

/// Mends crossings within shells on a copy, and takes it only if it is sound and close to what it
/// was.
bool mend(Work& work, std::size_t pairs) {
    mesh::TriMesh mended = work.mesh;
    if (pairs > kFewCrossings || !untangle(mended) || !mesh::check_topology(mended).manifold()) {
        return false;
    }
    const double shift = farthest_mm(mended, work.mesh);
    const double before = mesh::volume_mm3(work.mesh);
    const double change = mesh::volume_mm3(mended) - before;
    if (count_crossings(mended).within > 0 ||
        shift > kLargestMendedShift * mesh::diagonal_mm(work.mesh) ||
        std::abs(change) > kLargestMendedVolume * std::abs(before)) {
        return false;
    }
    work.mesh = std::move(mended);
    work.surface_moved = true;
    work.change(Status::Fixed, "mended " + counted(pairs, "crossing") +
                                   " of triangles within a shell, moving it by up to " +
                                   figure(shift) + " mm and its volume by " +
                                   percent(change, before));
    return true;
}

/// Cuts a shell that crosses itself along the crossings and keeps the boundary of what it winds
/// around.
bool resolve(Work& work, std::size_t pairs) {
    if (pairs > std::max(kAlwaysCut, work.mesh.triangles.size() / 2)) {
        return false;
    }
    Result<mesh::TriMesh> resolved = resolve_crossings(work.mesh);
    if (!resolved || resolved->triangles.empty() || !remove_slivers(*resolved) ||
        !mesh::check_topology(*resolved).manifold() || !self_intersections(*resolved, 1).empty()) {
        return false;
    }
    const double before = mesh::volume_mm3(work.mesh);
    work.mesh = std::move(*resolved);
    work.change(Status::United, "cut shells that cross themselves, in " + counted(pairs, "pair") +
                                    " of triangles, and kept the outside: volume " +
                                    figure(before) + " -> " + figure(mesh::volume_mm3(work.mesh)) +
                                    " mm^3, overlaps counted once");
    return true;
}

/// Rounding may have made points equal or triangles flat.
bool tidy_after_union(Work& work) {
    weld(work.mesh);
    drop_degenerate(work.mesh);
    drop_duplicates(work.mesh);
    split_non_manifold(work.mesh);
    return remove_slivers(work.mesh) && mesh::check_topology(work.mesh).manifold();
}

Result<bool> unite(Work& work) {
    const double before = mesh::volume_mm3(work.mesh);
    const Result<UnitedShells> united = unite_shells(work.mesh, work.run);
    if (!united) {
        return united.error().code == "run.cancelled" ? Result<bool>(fail(united.error()))
                                                      : work.needs_wrap(united.error().message);
    }
    std::string words = "united " + counted(united->shells, "shell") + " that overlap into " +
                        std::to_string(united->groups) +
                        (united->groups == 1 ? " body" : " bodies");
    if (united->subtracted > 0) {
        words += ", subtracting " + std::to_string(united->subtracted) + " that face inward";
    }
    if (united->shrunk_mm > 0) {
        work.surface_moved = true;
        words += ", shrinking some that only touch by up to " + figure(united->shrunk_mm) + " mm";
    }
    work.change(Status::United, words + ": volume " + figure(before) + " -> " +
                                    figure(mesh::volume_mm3(work.mesh)) +
                                    " mm^3, overlaps counted once");
    if (!tidy_after_union(work)) {
        return work.needs_wrap("the united surface is no manifold after rounding");
    }
    return true;
}

}  // namespace

Result<bool> remove_crossings(Work& work) {
    Crossings count = count_crossings(work.mesh);
    if (count.within > 0 && !mend(work, count.within) &&
        !resolve(work, count.within + count.between)) {
        return work.needs_wrap("a shell crosses itself in " + counted(count.within, "pair") +
                               " of triangles");
    }
    count = count.within > 0 ? count_crossings(work.mesh) : count;
    if (count.between > 0) {
        Result<bool> united = unite(work);
        if (!united || !*united) {
            return united;
        }
        count = count_crossings(work.mesh);
        if (count.between > 0 || (count.within > 0 && !mend(work, count.within))) {
            return work.needs_wrap("the united surface crosses itself after rounding");
        }
    }
    return true;
}

}  // namespace decomp::repair
