// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/repair.h"

#include "decomp/base/number.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/edges.h"
#include "decomp/repair/holes.h"
#include "decomp/repair/intersect.h"
#include "decomp/repair/shells.h"
#include "decomp/repair/soup.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace decomp::repair {

namespace {

/// "3 points", "1 point".
std::string counted(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// The chain of steps, from the mildest on; each says what it changed.
class Chain {
  public:
    Chain(const mesh::TriMesh& soup, const RepairOptions& options, const Run& run)
        : mesh_(soup), options_(options), run_(run) {
        report_.volume_before_mm3 = mesh::volume_mm3(soup);
    }

    Result<Repaired> solid() {
        clean_up();
        if (mesh_.triangles.empty()) {
            return fail("repair.empty", "no triangle has an area", "",
                        "check the unit and that the export was complete");
        }
        run_.progress("repair", 0.2);
        if (Outcome status = close(); !status) {
            return fail(status.error());
        }
        run_.progress("repair", 0.5);
        if (run_.cancelled()) {
            return cancelled();
        }
        arrange();
        if (!self_intersections(mesh_, 1).empty()) {
            return fail("repair.failed", "the surface intersects itself");
        }
        report_.volume_after_mm3 = mesh::volume_mm3(mesh_);
        if (mesh_.triangles.empty() || report_.volume_after_mm3 <= 0) {
            return fail("repair.not_a_solid", "the surface encloses no volume");
        }
        run_.progress("repair", 1);
        return Repaired{std::move(mesh_), std::move(report_)};
    }

  private:
    using Outcome = decomp::Status;

    void change(Status at_least, std::string words) {
        report_.status = std::max(report_.status, at_least);
        run_.info("repair: " + words);
        report_.changes.push_back(std::move(words));
    }

    void clean_up() {
        if (const std::size_t merged = weld(mesh_); merged > 0) {
            change(Status::Clean, "merged " + counted(merged, "point") + " with equal coordinates");
        }
        if (const std::size_t dropped = drop_degenerate(mesh_); dropped > 0) {
            change(Status::Fixed,
                   "removed " + counted(dropped, "triangle") + " that repeat a corner");
        }
        const DroppedDuplicates doubles = drop_duplicates(mesh_);
        if (doubles.copies > 0) {
            change(Status::Fixed,
                   "removed " + counted(doubles.copies, "triangle") + " that occurred twice");
        }
        if (doubles.wall_pairs > 0) {
            change(Status::Fixed, "removed " + counted(doubles.wall_pairs, "pair") +
                                      " of opposite triangles (inner walls)");
        }
    }

    /// Makes a closed oriented manifold of the triangles, by index work and small holes.
    Outcome close() {
        mesh::TopologyReport topology = mesh::check_topology(mesh_);
        if (!topology.manifold()) {
            if (const std::size_t turned = orient_consistently(mesh_); turned > 0) {
                senses_trusted_ = false;
                change(Status::Fixed,
                       "turned " + counted(turned, "triangle") + " to face as the neighbours do");
            }
            if (const std::size_t added = split_non_manifold(mesh_); added > 0) {
                change(Status::Fixed, "cut the surface apart where it touches itself, doubling " +
                                          counted(added, "point"));
            }
            topology = mesh::check_topology(mesh_);
        }
        if (topology.non_manifold_edges + topology.misoriented_edges +
                topology.non_manifold_vertices >
            0) {
            return fail("repair.not_a_solid", "the surface has one side only, or more than two");
        }
        if (topology.border_edges > 0) {
            if (Outcome status = close_holes(topology.border_edges); !status) {
                return status;
            }
        }
        const Result<std::size_t> slivers = remove_slivers(mesh_);
        if (!slivers) {
            return fail(slivers.error());
        }
        if (*slivers > 0) {
            change(Status::Fixed, "removed " + counted(*slivers, "triangle") + " without area");
        }
        return {};
    }

    Outcome close_holes(std::size_t border_edges) {
        const double edges = (3.0 * static_cast<double>(mesh_.triangles.size()) +
                              static_cast<double>(border_edges)) /
                             2;
        if (static_cast<double>(border_edges) > options_.largest_hole_share * edges) {
            return fail("repair.not_a_solid", "the surface is open along " +
                                                  counted(border_edges, "edge") + " of " +
                                                  std::to_string(static_cast<std::size_t>(edges)));
        }
        const Result<FilledHoles> filled = fill_holes(mesh_);
        if (!filled) {
            return fail(filled.error());
        }
        change(Status::Fixed, "filled " + counted(filled->holes, "hole") + " with " +
                                  counted(filled->triangles, "triangle") + " of " +
                                  shortest_area(filled->area_mm2));
        return {};
    }

    static std::string shortest_area(double area_mm2) { return decimal(area_mm2, 3) + " mm^2"; }

    void arrange() {
        const ShellReport shells = arrange_shells(mesh_, senses_trusted_);
        report_.shells = shells.shells;
        report_.voids = shells.voids;
        if (shells.turned > 0) {
            change(Status::Clean,
                   "turned " + counted(shells.turned, "shell") + " inside out to face outward");
        }
        if (shells.alternated > 0) {
            change(Status::Fixed, "turned " + counted(shells.alternated, "shell") +
                                      " so that solid and cavity alternate");
        }
        if (shells.dropped > 0) {
            change(Status::Fixed, "removed " + counted(shells.dropped, "shell") +
                                      " that bound nothing: solid within solid, " +
                                      decimal(shells.dropped_volume_mm3, 3) + " mm^3");
        }
    }

    mesh::TriMesh mesh_;
    RepairReport report_;
    bool senses_trusted_ = true;
    const RepairOptions& options_;
    const Run& run_;
};

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
    return Chain(soup, options, run).solid();
}

}  // namespace decomp::repair
