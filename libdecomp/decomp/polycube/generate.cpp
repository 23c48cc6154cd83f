// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/polycube/generate.h"

#include "decomp/base/parallel.h"
#include "decomp/cells/cells.h"
#include "decomp/polycube/candidate_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace decomp::polycube {

namespace {

constexpr double kHighestCompactness = 1000;
constexpr double kDetailCompactness = 2;  // where the pull on the normals makes the detail
constexpr int kFinerProxy = 3;            // halves of the proxy's triangles for a second try

/// How strongly normals are pulled for more detail than they hold, ever stronger.
constexpr std::array<std::array<double, 2>, 4> kDetail{{{0.3, 1}, {1, 0.5}, {1, 0.3}, {1, 0}}};

Status check(const mesh::TriMesh& volume, const GenerateOptions& options) {
    const auto wrong = [](const std::string& what) {
        return Status(fail("polycube.options", what));
    };
    if (volume.triangles.empty()) {
        return wrong("the volume is empty");
    }
    if (!(options.compactness > 0) || options.compactness > kHighestCompactness) {
        return wrong("compactness must lie above 0, at most 1000");
    }
    if (options.starts < 1 || options.starts > 5) {
        return wrong("starts must lie between 1 and 5");
    }
    if (options.target_parts < 0) {
        return wrong("the number of parts to aim at is negative");
    }
    return {};
}

map::DeformOptions pull(double lambda, double beta) {
    map::DeformOptions options;
    options.pull = lambda;
    options.smoothing = beta;
    return options;
}

Start detailed(std::size_t level, const GenerateOptions& options) {
    const auto& [lambda, beta] = kDetail.at(level);
    return {"detail " + std::to_string(level + 1), kDetailCompactness, 0, pull(lambda, beta),
            options.repair};
}

/// The labelings that compete, the plain one first.
std::vector<Start> starts_of(const GenerateOptions& options) {
    const double c = options.compactness;
    if (c < 1) {
        // 0.75 ... 1 is the first level of detail, 0 ... 0.25 the last.
        const auto level = static_cast<std::size_t>(std::clamp(std::floor(4 * (1 - c)), 0.0, 3.0));
        return {detailed(level, options)};
    }
    std::vector<Start> starts{{"direct", c, 0, {}, options.repair}};
    if (options.deformed_starts) {
        starts.push_back({"deformed 0.1", c, 0, pull(0.1, 1), options.repair});
        starts.push_back({"deformed 0.3", c, 0, pull(0.3, 1), options.repair});
        starts.push_back({"deformed 0.3 smoothed", c, 1, pull(0.3, 1), options.repair});
    }
    starts.push_back({"smoothed", c, 1, {}, options.repair});
    starts.resize(std::min(starts.size(), static_cast<std::size_t>(options.starts)));
    return starts;
}

/// Coarser and finer labelings about the given compactness, then levels of detail.
std::vector<Start> scan_of(const GenerateOptions& options) {
    std::vector<Start> starts;
    for (const double factor : {2.0, 1.4, 1.0, 0.7, 0.5}) {
        const double c = std::max(0.1, factor * options.compactness);
        starts.push_back(
            {"direct x " + std::to_string(factor).substr(0, 3), c, 0, {}, options.repair});
    }
    for (std::size_t level = 0; level < kDetail.size(); ++level) {
        starts.push_back(detailed(level, options));
    }
    return starts;
}

/// The candidates of these starts, side by side; failures are left out.
void append_candidates(const Solid& solid, std::span<const Start> starts,
                       const mesh::TriMesh& volume, const VoteError& vote_error, Run& run,
                       std::vector<Polycube>& out) {
    std::vector<Result<Polycube>> results(starts.size());
    for_each_index(run, results.size(), [&](std::size_t i) {
        Run inner = run;
        inner.jobs = 1;
        results[i] = candidate(solid, starts[i], volume, vote_error, inner);
    });
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (results[i]) {
            out.push_back(std::move(*results[i]));
        } else {
            run.info("start '" + starts[i].name + "' gave no map: " + results[i].error().message);
        }
    }
}

/// The least score; of equal ones the first.
const Polycube* best_of(const std::vector<Polycube>& candidates, int target_parts) {
    const Polycube* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const Polycube& candidate : candidates) {
        double score = candidate.figures.score;
        if (target_parts > 0) {
            constexpr double kFarFromTarget = 100;  // a factor of e
            score += kFarFromTarget *
                     std::abs(std::log(static_cast<double>(std::max(1, candidate.figures.cells)) /
                                       target_parts));
        }
        if (is_usable(candidate.figures) && score < least) {
            least = score;
            best = &candidate;
        }
    }
    return best;
}

/// All candidates of one proxy, as many as it takes.
Status compete(const mesh::TriMesh& volume, const GenerateOptions& options,
               const VoteError& vote_error, Run& run, std::vector<Polycube>& candidates) {
    const Result<Solid> solid = solid_of(volume, options, run);
    if (!solid) {
        return fail(solid.error());
    }
    if (options.target_parts > 0) {
        append_candidates(*solid, scan_of(options), volume, vote_error, run, candidates);
        return {};
    }
    const std::vector<Start> starts = starts_of(options);
    const std::span<const Start> all(starts);
    // The plain one alone, then two at a time whatever run.jobs is, until one is perfect.
    for (std::size_t begin = 0; begin < all.size() && !run.cancelled();) {
        const std::size_t count = begin == 0 ? 1 : std::min<std::size_t>(2, all.size() - begin);
        append_candidates(*solid, all.subspan(begin, count), volume, vote_error, run, candidates);
        if (std::any_of(candidates.begin(), candidates.end(),
                        [](const Polycube& made) { return is_perfect(made.figures); })) {
            break;
        }
        begin += count;
    }
    return {};
}

}  // namespace

Result<Polycube> generate(const mesh::TriMesh& volume, const GenerateOptions& options,
                          const VoteError& vote_error, Run& run) {
    if (Status status = check(volume, options); !status) {
        return fail(status.error());
    }
    run.progress("polycube", 0);
    std::vector<Polycube> candidates;
    Status status = compete(volume, options, vote_error, run, candidates);
    const Polycube* best = best_of(candidates, options.target_parts);
    if (!run.cancelled() && (best == nullptr || !best->figures.valid_labels)) {
        // A finer proxy holds thin walls and small handles apart.
        GenerateOptions finer = options;
        finer.proxy_triangles = std::max(options.proxy_triangles, 3000) * kFinerProxy / 2;
        status = compete(volume, finer, vote_error, run, candidates);
        best = best_of(candidates, options.target_parts);
    }
    if (run.cancelled()) {
        return cancelled();
    }
    Polycube out;
    if (best != nullptr) {
        out = *best;
    } else {
        run.warn("no labeling gave a usable map" +
                 (status ? std::string() : ": " + status.error().message) +
                 "; planes stand at cross-section events");
        out = identity_polycube(volume,
                                options.rotation ? *options.rotation : Eigen::Matrix3d::Identity());
        if (const auto cells = cells::cells_of(out.pair, out.lattice, {})) {
            out.figures.cells = static_cast<int>(cells->cells.size());
            out.figures.fragment_share = cells->fragment_share;
        }
    }
    out.figures.tried = static_cast<int>(candidates.size());
    run.progress("polycube", 1);
    return out;
}

}  // namespace decomp::polycube
