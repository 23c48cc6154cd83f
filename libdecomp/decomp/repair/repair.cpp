// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/repair.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/distance.h"
#include "decomp/repair/intersect.h"
#include "decomp/repair/shells.h"
#include "decomp/repair/soup.h"
#include "decomp/repair/work.h"

namespace decomp::repair {

namespace {

void clean_up(Work& work) {
    if (const std::size_t merged = weld(work.mesh); merged > 0) {
        work.change(Status::Clean,
                    "merged " + counted(merged, "point") + " with equal coordinates");
    }
    if (const std::size_t dropped = drop_degenerate(work.mesh); dropped > 0) {
        work.change(Status::Fixed,
                    "removed " + counted(dropped, "triangle") + " that repeat a corner");
    }
    const DroppedDuplicates doubles = drop_duplicates(work.mesh);
    if (doubles.copies > 0) {
        work.change(Status::Fixed,
                    "removed " + counted(doubles.copies, "triangle") + " that occurred twice");
    }
    if (doubles.wall_pairs > 0) {
        work.change(Status::Fixed, "removed " + counted(doubles.wall_pairs, "pair") +
                                       " of opposite triangles (inner walls)");
    }
}

void arrange(Work& work) {
    const ShellReport shells = arrange_shells(work.mesh, work.senses_trusted);
    work.report.shells = shells.shells;
    work.report.voids = shells.voids;
    if (shells.turned > 0) {
        work.change(Status::Clean,
                    "turned " + counted(shells.turned, "shell") + " inside out to face outward");
    }
    if (shells.alternated > 0) {
        work.change(Status::Fixed, "turned " + counted(shells.alternated, "shell") +
                                       " so that solid and cavity alternate");
    }
    if (shells.dropped > 0) {
        work.change(Status::Fixed, "removed " + counted(shells.dropped, "shell") +
                                       " within solid or around nothing, " +
                                       figure(shells.dropped_volume_mm3) +
                                       " mm^3 that change no boundary of the body");
    }
}

/// What every result must be, whatever the steps before believe.
decomp::Status check(const Work& work) {
    if (!mesh::check_topology(work.mesh).manifold()) {
        return fail("repair.failed", "the repaired surface is no closed manifold");
    }
    if (!self_intersections(work.mesh, 1).empty()) {
        return fail("repair.failed", "the repaired surface crosses itself", "",
                    "mend the mesh in a modeller");
    }
    return {};
}

void measure(Work& work, const mesh::TriMesh& soup) {
    RepairReport& report = work.report;
    report.volume_after_mm3 = mesh::volume_mm3(work.mesh);
    if (work.surface_moved) {
        report.hausdorff_mm = farthest_mm(work.mesh, soup);
    }
    if (report.status == Status::Wrapped) {
        report.hausdorff_mm = std::max(report.hausdorff_mm, farthest_mm(soup, work.mesh));
        work.change(Status::Wrapped,
                    "the wrap lies up to " + figure(report.hausdorff_mm) +
                        " mm off the input; its volume is " + figure(report.volume_after_mm3) +
                        " mm^3, the input's triangles sum to " + figure(report.volume_before_mm3));
    }
}

/// A volume below this share of area^1.5 is rounding, not a body.
constexpr double kLeastFullness = 1e-9;

Result<Repaired> made_solid(const mesh::TriMesh& soup, const RepairOptions& options,
                            const Run& run) {
    Work work{.mesh = soup, .report = {}, .wrap_reason = {}, .options = options, .run = run};
    work.report.volume_before_mm3 = mesh::volume_mm3(soup);
    clean_up(work);
    if (work.mesh.triangles.empty() || mesh::area_mm2(work.mesh) == 0) {
        return fail("repair.empty", "no triangle has an area", "",
                    "check the unit and that the export was complete");
    }
    mesh::TriMesh to_wrap = work.mesh;
    run.progress("repair", 0.2);
    bool sound = close_surface(work);
    if (sound) {
        to_wrap = work.mesh;  // closed, so that no wrap creeps in through a hole
    }
    run.progress("repair", 0.4);
    if (sound && !run.cancelled()) {
        const Result<bool> removed = remove_crossings(work);
        if (!removed) {
            return fail(removed.error());
        }
        sound = *removed;
    }
    run.progress("repair", 0.7);
    if (run.cancelled()) {
        return cancelled();
    }
    if (!sound) {
        if (decomp::Status wrapped = wrap_surface(work, to_wrap); !wrapped) {
            return fail(wrapped.error());
        }
    }
    arrange(work);
    measure(work, soup);
    if (!(work.report.volume_after_mm3 >
          kLeastFullness * std::pow(mesh::area_mm2(work.mesh), 1.5))) {
        return fail("repair.not_a_solid", "the surface encloses no volume", "",
                    "give the shape a thickness");
    }
    if (decomp::Status checked = check(work); !checked) {
        return fail(checked.error());
    }
    run.progress("repair", 1);
    return Repaired{std::move(work.mesh), std::move(work.report)};
}

}  // namespace

std::string_view name_of(Status status) {
    switch (status) {
        case Status::Clean:
            return "clean";
        case Status::Fixed:
            return "fixed";
        case Status::United:
            return "united";
        case Status::Wrapped:
            break;
    }
    return "wrapped";
}

Result<Repaired> repair(const mesh::TriMesh& soup, const RepairOptions& options, const Run& run) {
    if (run.cancelled()) {
        return cancelled();
    }
    return made_solid(soup, options, run);
}

}  // namespace decomp::repair
