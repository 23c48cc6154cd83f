// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/make_solid.h"

#include "decomp/base/number.h"
#include "decomp/mesh/measure.h"
#include "decomp/solid/boundary.h"
#include "decomp/solid/decimate.h"

#include <algorithm>
#include <cmath>

namespace decomp::solid {

namespace {

constexpr int kMostRefusals = 200;
constexpr int kMostRounds = 5;

/// Coordinates of about six digits, as files carry them, leave a plane by so much.
constexpr double kFileDigits = 2e-7;
constexpr double kLeastPlanarMm = 1e-9;

void give_way(const std::vector<std::int32_t>& refused, Regions& regions) {
    std::vector<bool> gone(regions.all.size(), false);
    for (const std::int32_t r : refused) {
        gone[static_cast<std::size_t>(r)] = true;
    }
    for (std::size_t t = 0; t < regions.of.size(); ++t) {
        const std::int32_t r = regions.of[t];
        if (r >= 0 && gone[static_cast<std::size_t>(r)]) {
            // A torus goes back to its bands, a band to its strips, a strip to its triangles.
            if (regions.band_of[t] != r) {
                regions.of[t] = regions.band_of[t];
                continue;
            }
            regions.of[t] = regions.plane_of[t] == r ? -1 : regions.plane_of[t];
            if (regions.plane_of[t] == r) {
                regions.plane_of[t] = -1;
            }
            regions.band_of[t] = regions.of[t];
        }
    }
}

/// Does every edge of the loop begin where the one before it ends?
bool is_closed(const Solid& solid, const Loop& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const EdgeUse& use = loop[i];
        const EdgeUse& next = loop[(i + 1) % loop.size()];
        const Edge& here = solid.edges[static_cast<std::size_t>(use.edge)];
        const Edge& then = solid.edges[static_cast<std::size_t>(next.edge)];
        if ((use.reversed ? here.from : here.to) != (next.reversed ? then.to : then.from)) {
            return false;
        }
    }
    return true;
}

/// Every edge once either way, every loop closed.
Status check(const Solid& solid) {
    std::vector<int> forward(solid.edges.size(), 0);
    std::vector<int> backward(solid.edges.size(), 0);
    for (const Face& face : solid.faces) {
        for (const Loop& loop : face.loops) {
            for (const EdgeUse& use : loop) {
                ++(use.reversed ? backward : forward)[static_cast<std::size_t>(use.edge)];
            }
            if (!is_closed(solid, loop)) {
                return fail("solid.unsound", "a loop of a face is not closed");
            }
        }
    }
    for (std::size_t e = 0; e < solid.edges.size(); ++e) {
        if (forward[e] != 1 || backward[e] != 1) {
            return fail("solid.unsound", "an edge is not used once either way",
                        "edge " + std::to_string(e));
        }
    }
    return {};
}

/// What is flat depends on the digits that the coordinates have.
RegionOptions region_options(const mesh::TriMesh& mesh, const SolidOptions& options) {
    const double reach_mm = mesh::bounds(mesh)
                                .min()
                                .cwiseAbs()
                                .cwiseMax(mesh::bounds(mesh).max().cwiseAbs())
                                .maxCoeff();
    return {.planar_mm = std::min(options.tolerance_mm / 4,
                                  std::max(kLeastPlanarMm, kFileDigits * reach_mm)),
            .tolerance_mm = options.tolerance_mm,
            .flat = options.detail != Detail::CutsAlone};
}

Regions recognise(const part::Part& part, const Adjacency& adjacency, const RegionOptions& options,
                  Detail detail) {
    Regions regions = find_planes(part, adjacency, options);
    if (detail == Detail::Curved) {
        find_curved(part, adjacency, options, regions);
    }
    return regions;
}

void carry_curved(const Regions& before, const std::vector<std::int32_t>& region_of,
                  Regions& after) {
    std::vector<std::int32_t> number(before.all.size(), -1);
    for (std::size_t t = 0; t < region_of.size(); ++t) {
        if (region_of[t] < 0) {
            continue;
        }
        const auto r = static_cast<std::size_t>(region_of[t]);
        if (std::holds_alternative<PlaneSurface>(before.all[r].surface)) {
            continue;
        }
        if (number[r] < 0) {
            number[r] = static_cast<std::int32_t>(after.all.size());
            after.all.push_back(before.all[r]);
        }
        after.of[t] = number[r];
    }
}

struct Fitted {
    Solid solid;
    double moved_mm = 0;
};

/// Bounds the regions; what cannot be bounded gives way to smaller faces. An empty solid where even
/// triangles alone do not do.
Result<Fitted> fit(const part::Part& part, const Adjacency& adjacency, Regions& regions,
                   const SolidOptions& options, const Run& run) {
    for (int round = 0; round < kMostRefusals; ++round) {
        if (run.cancelled()) {
            return cancelled();
        }
        const FaceMap faces = map_faces(part.mesh, adjacency, regions);
        const Settled settled = settle(part.mesh, regions, faces, options.tolerance_mm);
        if (!settled.refused.empty()) {
            give_way(settled.refused, regions);
            continue;
        }
        Bounded bounded = bound(part.mesh, adjacency, regions, faces, settled);
        if (bounded.refused.empty()) {
            return Fitted{std::move(bounded.solid), settled.farthest_mm};
        }
        give_way(bounded.refused, regions);
    }
    return Fitted{};
}

/// Is it a sound solid of no more faces than wanted?
Status check_wanted(const Solid& solid, const SolidOptions& options, const std::string& part) {
    if (solid.faces.empty()) {
        return fail("solid.unsound", "the faces of the part cannot be made to meet", part,
                    "repair the part, or export it as STL");
    }
    if (solid.faces.size() > options.max_faces && !options.force) {
        return fail("solid.too_many_faces",
                    "the solid needs " + std::to_string(solid.faces.size()) +
                        " faces to stay within " + decimal(options.tolerance_mm, 4) +
                        " mm, more than " + std::to_string(options.max_faces) +
                        ": CAD programs take minutes for it",
                    part, "allow a larger deviation with --step-tol, or add --step-many");
    }
    return check(solid);
}

/// Counts the surfaces of the regions that triangles still belong to.
void report_surfaces(const Regions& regions, SolidReport& report) {
    std::vector<bool> used(regions.all.size(), false);
    for (const std::int32_t r : regions.of) {
        if (r >= 0) {
            used[static_cast<std::size_t>(r)] = true;
        }
    }
    for (std::size_t r = 0; r < used.size(); ++r) {
        if (used[r]) {
            const Region& region = regions.all[r];
            report.planes += std::holds_alternative<PlaneSurface>(region.surface) ? 1U : 0U;
            report.cylinders += std::holds_alternative<CylinderSurface>(region.surface) ? 1U : 0U;
            report.cones += std::holds_alternative<ConeSurface>(region.surface) ? 1U : 0U;
            report.tori += std::holds_alternative<TorusSurface>(region.surface) ? 1U : 0U;
            report.sagitta_mm = std::max(report.sagitta_mm, region.sagitta_mm);
        }
    }
}

}  // namespace

Result<MadeSolid> make_solid(const part::Part& input, const SolidOptions& options, const Run& run) {
    MadeSolid made;
    part::Part part = input;
    auto adjacency = adjacency_of(part.mesh);
    if (!adjacency) {
        return fail(adjacency.error());
    }
    const RegionOptions flatness = region_options(part.mesh, options);
    Regions regions = recognise(part, *adjacency, flatness, options.detail);
    made.report.triangles = part.mesh.triangles.size();
    for (int round = 0; round < kMostRounds; ++round) {
        auto fitted = fit(part, *adjacency, regions, options, run);
        if (!fitted) {
            return fail(fitted.error());
        }
        made.solid = std::move(fitted->solid);
        made.report.moved_mm = fitted->moved_mm;
        if (made.solid.faces.size() <= options.max_faces || round + 1 == kMostRounds) {
            break;
        }
        // Regions may yet give way to their triangles: each round aims lower.
        auto decimated =
            decimate(part, *adjacency, regions,
                     {.tolerance_mm = options.tolerance_mm - made.report.decimation_mm,
                      .max_faces = options.max_faces -
                                   options.max_faces * static_cast<std::size_t>(round) / 50},
                     run);
        if (!decimated) {
            return fail(decimated.error());
        }
        if (decimated->removed_points == 0) {
            break;
        }
        made.report.removed_points += decimated->removed_points;
        made.report.decimation_mm += decimated->farthest_mm;
        part = std::move(decimated->part);
        adjacency = adjacency_of(part.mesh);
        if (!adjacency) {
            return fail(adjacency.error());
        }
        // What was curved has kept its triangles; what was joined is not asked again whether it is.
        Regions after = find_planes(part, *adjacency, flatness);
        carry_curved(regions, decimated->region_of, after);
        regions = std::move(after);
    }
    if (const Status sound = check_wanted(made.solid, options, part.id); !sound) {
        return fail(sound.error());
    }
    made.report.faces = made.solid.faces.size();
    report_surfaces(regions, made.report);
    return made;
}

}  // namespace decomp::solid
