// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/plan.h"

#include "decomp/base/parallel.h"
#include "decomp/mesh/measure.h"
#include "decomp/pipeline/candidates.h"
#include "decomp/pipeline/proxy.h"
#include "decomp/sections/trial_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace decomp::pipeline {

namespace {

// Weights of the search, in parts: a cost of 1 is worth one part more.
constexpr double kAreaWeight =
    0.6;  // cut area / volume^(2/3) of what is cut; 1 for a cube's middle
constexpr double kSupportWeight = 0.8;  // surface that needs support / surface
constexpr double kBalanceWeight =
    0.15;  // difference of the volumes on both sides / volume, away from necks
constexpr double kOffAxis =
    0.25;  // a plane perpendicular to no model axis, if nothing speaks for it
constexpr double kThinPenalty = 3;      // a tongue
constexpr double kSlimPenalty = 0.5;    // what is nearly one
constexpr double kSlimFactor = 2.5;     // "nearly", in units of thin_share
constexpr double kOversize = 0.35;      // per natural logarithm of a violation's ratio
constexpr double kExtraOutline = 0.1;   // per piece beyond two: more joints to glue
constexpr double kSharedBonus = 0.1;    // a plane that cuts a neighbour as well
constexpr double kSmallShare = 0.1;     // of the volume of the whole: parts below are shards ...
constexpr double kShardPenalty = 0.8;   // ... unless they hang on a neck
constexpr double kFeatherWeight = 1.6;  // share of the rim that ends in a feather edge
constexpr double kTopples = 0.5;        // a part that does not stand by itself
constexpr double kInflation = 1.002;    // stand-ins are judged this much larger than they are
constexpr double kTie = 1e-9;
constexpr double kNothing = 1e-7;    // of the volume
constexpr double kClearEvent = 0.3;  // strength from which a plane stays where its event is
constexpr std::array<double, 8> kPolish{-0.06, -0.045, -0.03, -0.015,
                                        0.015, 0.03,   0.045, 0.06};  // of the length
constexpr int kMaxDepth = 10;
constexpr int kMaxNodes =
    160;  // parts looked at in one search; what is beyond is estimated, and planned later
constexpr std::int32_t kFirstTrialPlane = 1 << 28;  // never the index of a real plane
constexpr double kFamily =
    0.9;  // cosine of about 25 degrees: directions closer than this are of one family

/// What is the same for the whole search.
struct Search {
    const DecomposeOptions& options;
    const part::Judge& judge;
    double diagonal_mm;  // of the whole shape
    double volume_mm3;
    Run& run;
};

/// Chambers that a misfit fills, at least 2: the parts to expect of it.
double parts_needed(const part::Verdict& verdict) {
    if (verdict.ok()) {
        return 1;
    }
    double chambers = 1;
    double oversize = 0;
    for (const part::Violation& violation : verdict.violations) {
        chambers *= std::ceil(std::min(violation.by_ratio, 1e3) - kTie);
        oversize += std::log(violation.by_ratio);
    }
    return std::max(2.0, chambers) + kOversize * oversize;
}

/// A candidate that was tried.
struct Trial {
    Candidate candidate;
    std::vector<sections::TrialPiece> pieces;
    std::vector<part::Verdict> verdicts;
    double penalty = 0;   // of this cut alone
    double estimate = 0;  // penalty and parts to expect
};

/// For tongues, and for shards: small pieces that do not hang on a neck.
double shape_penalty(const sections::TrialPiece& piece, const Search& search) {
    const double thin = search.options.thin_share * search.diagonal_mm;
    if (piece.bridge_mm < thin) {
        return kThinPenalty;
    }
    const double slim = kSlimFactor * thin;
    double penalty =
        piece.bridge_mm < slim ? kSlimPenalty * (slim - piece.bridge_mm) / (slim - thin) : 0;
    const double share = piece.volume_mm3 / (kSmallShare * search.volume_mm3);
    // A neck's width is well below the length of what hangs on it; half a ball has 0.33, half a
    // cube 0.5.
    const double hanging = piece.bridge_mm / std::sqrt(piece.interface_mm2);
    if (share < 1 && hanging < 1) {
        penalty += kShardPenalty * (1 - share) * (1 - hanging);
    }
    return penalty;
}

/// 0 where the volume is shared so that all parts to come may be of equal size, 1 halfway between
/// such shares or towards the ends.
double unevenness(double share, double parts) {
    const double count = std::max(2.0, std::floor(parts));
    const double nearest = std::clamp(std::round(share * count), 1.0, count - 1);
    return std::min(1.0, 2 * std::abs(share * count - nearest));
}

std::optional<Trial> tried(const part::Part& part, const Candidate& candidate, double needed,
                           int depth, const Search& search) {
    Trial trial;
    trial.candidate = candidate;
    trial.pieces = sections::trial_cut(part, candidate.plane, kFirstTrialPlane + depth);
    if (trial.pieces.size() < 2) {
        return std::nullopt;
    }
    double volume = 0;
    double above = 0;
    double interface = 0;
    double support = 0;
    for (const sections::TrialPiece& piece : trial.pieces) {
        volume += piece.volume_mm3;
        above += piece.above ? piece.volume_mm3 : 0;
        interface += piece.interface_mm2 / 2;
    }
    // Along a face that is there already, rounding gives pieces of nothing.
    const bool grazes = std::any_of(
        trial.pieces.begin(), trial.pieces.end(), [&](const sections::TrialPiece& piece) {
            return piece.volume_mm3 <= kNothing * volume || piece.interface_mm2 <= 0;
        });
    if (grazes) {
        return std::nullopt;
    }
    bool progress = true;
    for (const sections::TrialPiece& piece : trial.pieces) {
        trial.verdicts.push_back(search.judge(piece.part, part::Fidelity::Estimate));
        const part::Verdict& verdict = trial.verdicts.back();
        const double pieces_needed = parts_needed(verdict);
        trial.estimate += pieces_needed;
        support += verdict.ok() ? verdict.support_area_mm2 : 0;
        trial.penalty += shape_penalty(piece, search);
        trial.penalty += kFeatherWeight * piece.feather / 2;
        trial.penalty += verdict.ok() && !verdict.stable ? kTopples : 0;
        progress = progress && (verdict.ok() || piece.volume_mm3 < 0.9 * volume ||
                                pieces_needed < needed - 0.05);
    }
    if (!progress) {
        return std::nullopt;
    }
    const double imbalance = unevenness(above / volume, trial.estimate);
    trial.penalty += kAreaWeight * interface / std::pow(volume, 2.0 / 3.0);
    trial.penalty += kSupportWeight * support / mesh::area_mm2(part.mesh);
    trial.penalty += candidate.shared ? 0 : kBalanceWeight * imbalance * (1 - candidate.event);
    trial.penalty += candidate.natural ? 0 : kOffAxis * (1 - candidate.event);
    trial.penalty -= candidate.shared ? kSharedBonus : 0;
    trial.penalty += kExtraOutline * static_cast<double>(trial.pieces.size() - 2);
    trial.estimate += trial.penalty;
    return trial;
}

/// A part to be cut, and the planes that cut its neighbours.
struct Node {
    const part::Part& part;
    const part::Verdict& verdict;
    int depth;
    const std::vector<part::Plane>& known;
    const std::vector<part::Plane>& mapped;
};

std::vector<Trial> all_tried(const Node& node, const Search& search) {
    const int offsets =
        node.depth == 0 ? search.options.offsets : std::min(7, search.options.offsets);
    const std::vector<Candidate> planes =
        candidates(node.part, node.verdict, offsets, node.known, node.mapped);
    const double needed = parts_needed(node.verdict);
    std::vector<std::optional<Trial>> slots(planes.size());
    for_each_index(search.run, planes.size(), [&](std::size_t i) {
        slots[i] = tried(node.part, planes[i], needed, node.depth, search);
        if (slots[i]) {
            // Only the few that are followed need their meshes: they are made again.
            slots[i]->pieces.clear();
        }
    });
    std::vector<Trial> trials;
    for (std::optional<Trial>& slot : slots) {
        if (slot) {
            trials.push_back(std::move(*slot));
        }
    }
    std::stable_sort(trials.begin(), trials.end(),
                     [](const Trial& a, const Trial& b) { return a.estimate < b.estimate; });
    return trials;
}

/// The most promising trials: first the best of each family of directions, then the next best.
std::vector<Trial> most_promising(std::vector<Trial> trials, std::size_t count) {
    std::vector<Trial> out;
    std::vector<Trial> relatives;
    for (Trial& trial : trials) {
        const bool related = std::any_of(out.begin(), out.end(), [&](const Trial& other) {
            return std::abs(other.candidate.plane.normal.dot(trial.candidate.plane.normal)) >
                   kFamily;
        });
        if (related) {
            relatives.push_back(std::move(trial));
        } else if (out.size() < count) {
            out.push_back(std::move(trial));
        }
    }
    for (std::size_t i = 0; i < relatives.size() && out.size() < count; ++i) {
        out.push_back(std::move(relatives[i]));
    }
    return out;
}

/// The trial or a better one between it and the planes tried beside it.
Trial polished(const Node& node, const Trial& trial, const Search& search) {
    if (trial.candidate.shared || trial.candidate.event >= kClearEvent) {
        return trial;
    }
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Eigen::Vector3d& point : node.part.mesh.points) {
        low = std::min(low, trial.candidate.plane.normal.dot(point));
        high = std::max(high, trial.candidate.plane.normal.dot(point));
    }
    const double needed = parts_needed(node.verdict);
    std::array<std::optional<Trial>, kPolish.size()> slots;
    for_each_index(search.run, kPolish.size(), [&](std::size_t i) {
        Candidate shifted = trial.candidate;
        shifted.plane.offset_mm += kPolish.at(i) * (high - low);
        slots.at(i) = tried(node.part, shifted, needed, node.depth, search);
        if (slots.at(i)) {
            slots.at(i)->pieces.clear();
        }
    });
    const Trial* best = &trial;
    for (const std::optional<Trial>& slot : slots) {
        best = slot && slot->estimate < best->estimate - kTie ? &*slot : best;
    }
    return *best;
}

std::shared_ptr<PlannedCut> best_cut(const Node& node, int budget, const Search& search);

void collect_planes(const PlannedCut& cut, std::vector<part::Plane>& planes) {
    planes.push_back(cut.plane);
    for (const PlannedPiece& piece : cut.pieces) {
        if (piece.next) {
            collect_planes(*piece.next, planes);
        }
    }
}

/// Follows one trial to the end. What cuts one piece is offered to the next.
PlannedCut followed(const Node& node, const Trial& trial, int budget, const Search& search) {
    PlannedCut cut;
    cut.plane = trial.candidate.plane;
    cut.cost = trial.penalty;
    std::vector<part::Plane> known = node.known;
    const auto pieces = sections::trial_cut(node.part, cut.plane, kFirstTrialPlane + node.depth);
    const auto misfits = std::count_if(trial.verdicts.begin(), trial.verdicts.end(),
                                       [](const part::Verdict& verdict) { return !verdict.ok(); });
    const int share = misfits > 0 ? budget / static_cast<int>(misfits) : 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        PlannedPiece planned;
        planned.above = pieces[i].above;
        planned.volume_mm3 = pieces[i].volume_mm3;
        planned.centre = mesh::bounds(pieces[i].part.mesh).center();
        if (trial.verdicts[i].ok()) {
            cut.cost += 1;
        } else {
            planned.next =
                best_cut({pieces[i].part, trial.verdicts[i], node.depth + 1, known, node.mapped},
                         share, search);
            cut.cost += planned.next ? planned.next->cost : parts_needed(trial.verdicts[i]);
            if (planned.next) {
                collect_planes(*planned.next, known);
            }
        }
        cut.pieces.push_back(std::move(planned));
    }
    return cut;
}

std::shared_ptr<PlannedCut> best_cut(const Node& node, int budget, const Search& search) {
    if (node.depth >= kMaxDepth || budget < 1 || search.run.cancelled()) {
        return nullptr;
    }
    const auto width = static_cast<std::size_t>(node.depth == 0   ? search.options.lookahead
                                                : node.depth == 1 ? 3
                                                : node.depth == 2 ? 2
                                                                  : 1);
    std::shared_ptr<PlannedCut> best;
    const std::vector<Trial> trials = most_promising(all_tried(node, search), width);
    for (const Trial& unpolished : trials) {
        const Trial trial = polished(node, unpolished, search);
        const int share = (budget - 1) / static_cast<int>(trials.size());
        auto cut = std::make_shared<PlannedCut>(followed(node, trial, share, search));
        if (!best || cut->cost < best->cost - kTie) {
            best = std::move(cut);
        }
    }
    return best;
}

/// The planes as they lie in the inflated stand-in.
std::vector<part::Plane> inflated(std::vector<part::Plane> planes, const Eigen::Vector3d& centre) {
    for (part::Plane& plane : planes) {
        const double at_centre = plane.normal.dot(centre);
        plane.offset_mm = at_centre + (plane.offset_mm - at_centre) * kInflation;
    }
    return planes;
}

/// Carries a plan from the inflated stand-in back to the part.
void deflate(PlannedCut& cut, const Eigen::Vector3d& centre) {
    // x' = c + s (x - c): n . x' = d  <=>  n . x = n . c + (d - n . c) / s
    const double at_centre = cut.plane.normal.dot(centre);
    cut.plane.offset_mm = at_centre + (cut.plane.offset_mm - at_centre) / kInflation;
    for (PlannedPiece& piece : cut.pieces) {
        piece.volume_mm3 /= kInflation * kInflation * kInflation;
        piece.centre = centre + (piece.centre - centre) / kInflation;
        if (piece.next) {
            deflate(*piece.next, centre);
        }
    }
}

}  // namespace

std::shared_ptr<PlannedCut> plan_cut(const part::Part& part, const DecomposeOptions& options,
                                     const part::Judge& judge, const Whole& root,
                                     const Hints& hints, Run& run) {
    part::Part stand_in =
        simplified(part, static_cast<std::size_t>(std::max(500, options.proxy_triangles)));
    const Eigen::Vector3d centre = mesh::bounds(stand_in.mesh).center();
    for (Eigen::Vector3d& point : stand_in.mesh.points) {
        point = centre + kInflation * (point - centre);
    }
    const Search search{options, judge, root.diagonal_mm, root.volume_mm3, run};
    const part::Verdict verdict = judge(stand_in, part::Fidelity::Estimate);
    const std::vector<part::Plane> known = inflated(hints.known, centre);
    const std::vector<part::Plane> mapped = inflated(hints.mapped, centre);
    std::shared_ptr<PlannedCut> plan =
        best_cut({stand_in, verdict, 0, known, mapped}, kMaxNodes, search);
    if (plan) {
        deflate(*plan, centre);
    }
    return plan;
}

}  // namespace decomp::pipeline
