// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cells/cells.h"
#include "decomp/labels/report.h"
#include "decomp/map/map.h"
#include "decomp/map/quantise.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/polycube/candidate_detail.h"
#include "decomp/proxy/orientation.h"
#include "decomp/proxy/proxy.h"
#include "decomp/tets/boundary.h"
#include "decomp/tets/tetrahedralise.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace decomp::polycube {

namespace {

constexpr double kMergeShare = 0.08;    // of the extent: planes of the lattice nearer become one
constexpr double kWorthTurning = 0.95;  // of the misalignment as the model stands
constexpr double kFaithful = 0.8;
constexpr double kUnfaithful = 0.3;
constexpr double kFewFragments = 0.05;
constexpr std::size_t kFewFolds = 20;
constexpr double kMostFlipped = 0.1;  // of the volume

// Weights of the score. Corners and charts must not count: any weight picks the one-block answer.
constexpr double kInvalid = 1e4;
constexpr double kTurningPoint = 10;
constexpr double kFlip = 5;
constexpr double kFold = 0.5;
constexpr std::size_t kMostFlips = 20;
constexpr double kFragmentPercent = 2;
constexpr double kVotePercent = 3;
constexpr double kLostFidelity = 100;  // below kFaithful

double score_of(const Figures& f) {
    return (f.valid_labels ? 0 : kInvalid) + kTurningPoint * f.turning_points +
           kFlip * static_cast<double>(std::min(f.flips, kMostFlips)) +
           kFold * static_cast<double>(std::min(f.folds, kMostFlips)) +
           100 * kFragmentPercent * f.fragment_share + 100 * kVotePercent * f.vote_error +
           kLostFidelity * std::max(0.0, kFaithful - f.fidelity);
}

/// Facets of the boundary that look against their label: the surface is folded there.
std::size_t folds_of(const Polycube& polycube) {
    std::size_t folds = 0;
    const auto facets = tets::boundary_of(polycube.pair.tets);
    for (std::size_t i = 0; i < facets.size(); ++i) {
        const auto& [a, b, c] = facets[i].corners;
        const auto& at = polycube.pair.polycube;
        const Eigen::Vector3d normal = (at[b] - at[a]).cross(at[c] - at[a]);
        const labels::AxisLabel label = polycube.labels[i];
        folds += normal[labels::axis_of(label)] * labels::sign_of(label) > 0 ? 0 : 1;
    }
    return folds;
}

std::string tier_of(const Figures& f) {
    if (!f.valid_labels) {
        return "T3";
    }
    return f.flips == 0 ? "T1" : "T2";
}

/// Tets sampled anew, numbered so that their boundary's points come first.
Solid anew(const tets::TetMesh& tets) {
    const tets::BoundarySurface boundary = tets::boundary_surface(tets.points, tets.tets);
    Solid solid;
    solid.surface = boundary.surface;
    solid.tets.points = boundary.surface.points;
    std::vector<std::int64_t> number(tets.points.size(), -1);
    for (std::size_t i = 0; i < boundary.points_from.size(); ++i) {
        number[boundary.points_from[i]] = static_cast<std::int64_t>(i);
    }
    for (std::size_t i = 0; i < tets.points.size(); ++i) {
        if (number[i] < 0) {
            number[i] = static_cast<std::int64_t>(solid.tets.points.size());
            solid.tets.points.push_back(tets.points[i]);
        }
    }
    for (tets::Tet tet : tets.tets) {
        for (std::uint32_t& corner : tet) {
            corner = static_cast<std::uint32_t>(number[corner]);
        }
        solid.tets.tets.push_back(tet);
    }
    return solid;
}

void turn(Solid& solid, const Eigen::Matrix3d& rotation) {
    solid.rotation = rotation;
    solid.turned_surface = solid.surface;
    solid.turned_tets = solid.tets;
    if (rotation.isIdentity(0)) {
        return;
    }
    for (Eigen::Vector3d& p : solid.turned_surface.points) {
        p = rotation * p;
    }
    for (Eigen::Vector3d& p : solid.turned_tets.points) {
        p = rotation * p;
    }
}

Eigen::Matrix3d chosen_rotation(const mesh::TriMesh& surface) {
    const auto candidates = proxy::orientation_candidates(surface);
    const double now = proxy::misalignment(surface, Eigen::Matrix3d::Identity());
    Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
    double least = kWorthTurning * now;
    for (const Eigen::Matrix3d& rotation : candidates) {
        const double mine = proxy::misalignment(surface, rotation);
        if (mine < least) {
            least = mine;
            best = rotation;
        }
    }
    return best;
}

}  // namespace

bool is_perfect(const Figures& f) {
    return f.valid_labels && f.turning_points == 0 && f.flips == 0 && f.folds <= kFewFolds &&
           f.fidelity >= kFaithful && f.fragment_share <= kFewFragments;
}

bool is_usable(const Figures& f) {
    return f.fidelity >= kUnfaithful && f.flipped_share <= kMostFlipped && f.cells >= 1;
}

Result<Polycube> candidate(const Solid& solid, const Start& start, const mesh::TriMesh& volume,
                           const VoteError& vote_error, Run& run) {
    std::vector<Eigen::Vector3d> normals;
    if (start.deform) {
        normals =
            map::deformed_normals(solid.turned_tets, solid.turned_surface, *start.deform, run);
    }
    const Result<labels::Labeling> labels = labels::label(
        solid.turned_surface, normals,
        {.compactness = start.compactness, .smoothing = start.smoothing, .repair = start.repair},
        run);
    if (!labels) {
        return fail(labels.error());
    }
    const labels::LabelReport report = labels::report(solid.turned_surface, *labels);
    Result<map::MapResult> mapped =
        map::map_to_polycube(solid.turned_tets, solid.turned_surface, *labels, {}, run);
    if (!mapped) {
        return fail(mapped.error());
    }
    Polycube out;
    out.lattice = map::quantise(*mapped, kMergeShare);
    out.labels = std::move(mapped->labels);
    out.rotation = solid.rotation;
    out.pair = std::move(mapped->pair);
    // Back into the model frame; what was there keeps its bits.
    for (std::size_t i = 0; i < out.pair.shape.size(); ++i) {
        out.pair.shape[i] = i < solid.tets.points.size()
                                ? solid.tets.points[i]
                                : Eigen::Vector3d(solid.rotation.transpose() * out.pair.shape[i]);
    }
    Figures& f = out.figures;
    f.start = start.name;
    f.proxy_triangles = solid.surface.triangles.size();
    f.proxy_distance_mm = solid.proxy_distance_mm;
    f.charts = report.charts;
    f.corners = report.corners;
    f.turning_points = report.turning_points;
    f.valid_labels = report.valid();
    f.fidelity = report.fidelity;
    f.tets = mapped->measures.tets;
    f.flips = mapped->measures.flips;
    f.folds = folds_of(out);
    f.flipped_share = mapped->measures.flipped_share;
    f.symmetric_dirichlet = mapped->measures.symmetric_dirichlet;
    const Result<cells::CellComplex> cells = cells::cells_of(out.pair, out.lattice, {});
    if (!cells) {
        return fail(cells.error());
    }
    f.cells = static_cast<int>(cells->cells.size());
    f.fragment_share = cells->fragment_share;
    if (vote_error) {
        f.vote_error = vote_error(out.pair, out.lattice, volume);
    }
    f.score = score_of(f);
    out.tier = tier_of(f);
    return out;
}

Result<Solid> solid_of(const mesh::TriMesh& volume, const GenerateOptions& options, Run& run) {
    Result<proxy::Proxy> proxy =
        proxy::make_proxy(volume, {.triangles = options.proxy_triangles}, run);
    if (!proxy) {
        return fail(proxy.error());
    }
    Solid solid;
    Result<tets::TetMesh> tets = tets::tetrahedralise(proxy->surface, run);
    if (tets) {
        solid.surface = std::move(proxy->surface);
        solid.tets = std::move(*tets);
    } else {
        run.warn("the proxy is sampled anew: " + tets.error().message);
        tets = tets::tetrahedralise_anew(proxy->surface, proxy->edge_mm, run);
        if (!tets) {
            return fail(tets.error());
        }
        solid = anew(*tets);
        if (!mesh::check_topology(solid.surface).manifold()) {
            return fail("tets.failed", "the boundary of the tets is no manifold");
        }
    }
    solid.proxy_distance_mm = proxy->distance_mm;
    turn(solid, options.rotation ? *options.rotation : chosen_rotation(solid.surface));
    return solid;
}

}  // namespace decomp::polycube
