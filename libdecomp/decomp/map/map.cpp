// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/map.h"

#include "decomp/map/arap_detail.h"
#include "decomp/map/constraints_detail.h"
#include "decomp/map/energy_detail.h"
#include "decomp/map/lbfgs_detail.h"
#include "decomp/tets/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace decomp::map {

namespace {

constexpr double kFloor = 1e-5;  // of epsilon
constexpr double kFirstEpsilon = 1e-3;
constexpr int kSweeps = 10;
constexpr double kSettled = 1e-3;  // share of the energy gained in a round, without flips
constexpr int kPatience = 8;       // rounds before being stuck ends a try
constexpr double kStuck = 1e-5;    // the same, with flips
constexpr double kKept = 0.5;      // of the polycube's volume

mesh::Triangle sorted(mesh::Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
}

/// eps = sqrt(floor^2 + 0.04 detmin^2), evaluated anew in each round. The multiplicative schedule
/// with a convergence proof diverges as soon as one tet cannot be satisfied.
double epsilon_of(double least_determinant) {
    constexpr double kShare = 0.04;
    return least_determinant > 0
               ? kFloor
               : std::sqrt(kFloor * kFloor + kShare * least_determinant * least_determinant);
}

template <class Element>
void mark(const Element& corners, std::vector<char>& marks) {
    for (const std::uint32_t corner : corners) {
        marks[corner] = 1;
    }
}

/// Marks the points of flipped tets, and those within `rings` of them.
std::vector<char> near_flips(const std::vector<Eigen::Vector3d>& at,
                             const std::vector<tets::Tet>& tets, int rings) {
    std::vector<char> near(at.size(), 0);
    for (const tets::Tet& tet : tets) {
        if (!(tets::six_volumes(at, tet) > 0)) {
            mark(tet, near);
        }
    }
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<char> next = near;
        for (const tets::Tet& tet : tets) {
            if (std::any_of(tet.begin(), tet.end(), [&](auto c) { return near[c] != 0; })) {
                mark(tet, next);
            }
        }
        near = std::move(next);
    }
    return near;
}

using Neighbours = std::vector<std::vector<std::uint32_t>>;

/// Of the points marked as near: of surface points along the surface, of inner points in the
/// volume; as often as triangles or tets say so.
Neighbours neighbours_of(const LabelledTets& tets, const std::vector<char>& near) {
    std::vector<char> outer(near.size(), 0);
    for (const mesh::Triangle& t : tets.facets) {
        mark(t, outer);
    }
    Neighbours neighbours(near.size());
    const auto connect = [&](std::uint32_t a, std::uint32_t b, bool surface) {
        if (a != b && near[a] != 0 && (outer[a] != 0) == surface) {
            neighbours[a].push_back(b);
        }
    };
    for (const mesh::Triangle& t : tets.facets) {
        for (std::size_t k = 0; k < 3; ++k) {
            connect(t.at(k), t.at((k + 1) % 3), true);
        }
    }
    for (const tets::Tet& tet : tets.mesh.tets) {
        for (const std::uint32_t a : tet) {
            for (const std::uint32_t b : tet) {
                connect(a, b, false);
            }
        }
    }
    return neighbours;
}

/// One map in the making.
class Untangler {
  public:
    Untangler(LabelledTets tets, const MapOptions& options)
        : tets_(std::move(tets)), options_(options), unknowns_(unknowns_of(tets_)) {}

    void start() { x_ = arap_start(tets_.mesh, unknowns_, options_.arap_rounds); }

    /// Minimises with falling epsilon until nothing is flipped and little is gained, or stuck.
    /// Returns the number of flips.
    std::size_t untangle(const Run& run, bool fresh) {
        const FoldoverEnergy energy(tets_.mesh.points, tets_.mesh.tets,
                                    rows_of(unknowns_, tets_.mesh.tets));
        const double size = x_.maxCoeff() - x_.minCoeff();
        double last = std::numeric_limits<double>::infinity();
        auto state = energy.determinants(x_);
        int left = options_.budget;
        for (int round = 0; round < options_.rounds && left > 0 && !run.cancelled(); ++round) {
            double eps = epsilon_of(state.least);
            if (round == 0 && fresh) {
                eps = std::max(eps, kFirstEpsilon);
            }
            LbfgsOptions lbfgs;
            lbfgs.iterations = std::min(options_.iterations, left);
            constexpr double kFirstStep = 1e-2;
            lbfgs.first_step = kFirstStep * size;
            const LbfgsResult result = minimise(
                x_,
                [&](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
                    return energy(x, eps, gradient);
                },
                lbfgs);
            iterations_ += result.iterations;
            left -= result.iterations;
            state = energy.determinants(x_);
            const double gain = last - result.value;
            if ((state.flips == 0 && gain < kSettled * result.value) ||
                (state.flips > 0 && round > kPatience && std::abs(gain) < kStuck * result.value)) {
                break;
            }
            last = result.value;
        }
        return state.flips;
    }

    /// Moves the points of flipped tets, and those within `rings` of them, to the means of their
    /// neighbours, chart by chart in its plane: where a triangle of a chart is inverted, the energy
    /// pulls both its base and its height to zero and cannot choose which one to turn.
    void relax(int rings) {
        const std::vector<char> near = near_flips(pair().polycube, tets_.mesh.tets, rings);
        const Neighbours neighbours = neighbours_of(tets_, near);
        std::vector<std::uint32_t> sharers(unknowns_.count, 0);
        for (const auto& row : unknowns_.of_point) {
            for (const std::uint32_t u : row) {
                ++sharers[u];
            }
        }
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            for (std::size_t p = 0; p < near.size(); ++p) {
                if (near[p] != 0 && !neighbours[p].empty()) {
                    move_to_mean(p, neighbours[p], sharers);
                }
            }
        }
    }

    [[nodiscard]] tets::Pair pair() const {
        tets::Pair out{tets_.mesh.points, {}, tets_.mesh.tets};
        out.polycube.reserve(out.shape.size());
        for (const auto& row : unknowns_.of_point) {
            out.polycube.emplace_back(x_[row[0]], x_[row[1]], x_[row[2]]);
        }
        return out;
    }

    [[nodiscard]] const LabelledTets& tets() const { return tets_; }

    [[nodiscard]] int iterations() const { return iterations_; }

  private:
    /// Along the axes in which a point is not bound to a chart.
    void move_to_mean(std::size_t point, const std::vector<std::uint32_t>& neighbours,
                      const std::vector<std::uint32_t>& sharers) {
        for (std::size_t d = 0; d < 3; ++d) {
            const std::uint32_t mine = unknowns_.of_point[point].at(d);
            if (sharers[mine] > 1) {
                continue;  // a whole chart's
            }
            double sum = 0;
            for (const std::uint32_t q : neighbours) {
                sum += x_[unknowns_.of_point[q].at(d)];
            }
            x_[mine] = sum / static_cast<double>(neighbours.size());
        }
    }

    LabelledTets tets_;
    MapOptions options_;
    Unknowns unknowns_;
    Eigen::VectorXd x_;
    int iterations_ = 0;
};

/// The labels of the facets, listed in boundary order.
labels::Labeling in_boundary_order(const LabelledTets& tets) {
    std::vector<std::pair<mesh::Triangle, labels::AxisLabel>> known;
    known.reserve(tets.facets.size());
    for (std::size_t f = 0; f < tets.facets.size(); ++f) {
        known.emplace_back(sorted(tets.facets[f]), tets.labels[f]);
    }
    std::sort(known.begin(), known.end());
    labels::Labeling out;
    for (const auto& facet : tets::boundary_of(tets.mesh.tets)) {
        const mesh::Triangle key = sorted(facet.corners);
        const auto found = std::lower_bound(
            known.begin(), known.end(), key,
            [](const auto& entry, const mesh::Triangle& wanted) { return entry.first < wanted; });
        out.push_back(found->second);
    }
    return out;
}

Status check(const tets::TetMesh& tets, const mesh::TriMesh& surface,
             const labels::Labeling& labels) {
    if (labels.size() != surface.triangles.size()) {
        return fail("map.labels", std::to_string(labels.size()) + " labels for " +
                                      std::to_string(surface.triangles.size()) + " triangles");
    }
    std::vector<mesh::Triangle> boundary;
    for (const auto& facet : tets::boundary_of(tets.tets)) {
        boundary.push_back(sorted(facet.corners));
    }
    std::vector<mesh::Triangle> labelled;
    for (const mesh::Triangle& t : surface.triangles) {
        labelled.push_back(sorted(t));
    }
    std::sort(boundary.begin(), boundary.end());
    std::sort(labelled.begin(), labelled.end());
    if (boundary != labelled) {
        return fail("map.labels", "the labelled surface is not the boundary of the tets");
    }
    return {};
}

}  // namespace

Result<MapResult> map_to_polycube(const tets::TetMesh& tets, const mesh::TriMesh& surface,
                                  const labels::Labeling& labels, const MapOptions& options,
                                  Run& run) {
    if (Status status = check(tets, surface, labels); !status) {
        return fail(status.error());
    }
    LabelledTets labelled{tets, surface.triangles, labels, {}};
    MapResult result;
    result.splits = split_about_corners(labelled);
    result.splits += split_bound_edges(labelled);
    Untangler untangler(std::move(labelled), options);
    untangler.start();
    const Untangler started = untangler;
    std::size_t flips = untangler.untangle(run, true);
    for (int attempt = 0;
         attempt < options.recoveries && flips > 0 && flips <= options.hopeless && !run.cancelled();
         ++attempt) {
        Untangler other = started;
        other.relax(1 + attempt);
        const std::size_t others = other.untangle(run, false);
        // A polycube that shrank to lose its last flips is worse than a few flips.
        if (others < flips && tets::measure(other.pair()).polycube_mm3 >=
                                  kKept * tets::measure(untangler.pair()).polycube_mm3) {
            untangler = std::move(other);
            flips = others;
        }
    }
    if (run.cancelled()) {
        return cancelled();
    }
    result.pair = untangler.pair();
    result.labels = in_boundary_order(untangler.tets());
    result.measures = tets::measure(result.pair);
    result.iterations = untangler.iterations();
    return result;
}

}  // namespace decomp::map
