// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/repair.h"

#include "decomp/labels/graph_cut.h"
#include "decomp/labels/layout.h"
#include "decomp/labels/operators.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace decomp::labels {

namespace {

constexpr double kViolationWorth = 3;       // percent of the area at full misfit
constexpr double kTurnWorth = 1.5;          // likewise
constexpr double kConstructionPrice = 0.3;  // of the energy lost; a deletion pays all of it
constexpr double kForce = 4;                // mean facet costs
constexpr double kDeletionCap = 1;          // earlier costs of the labels that shall take over
constexpr double kLeastGain = 1e-6;
constexpr int kFreeRings = 6;
constexpr int kMostRounds = 120;
constexpr int kMostProposals = 4000;
constexpr double kStillUseful = 0.7;       // of the gain before another change was made
constexpr double kFidelityPerStep = 0.02;  // may be lost for each violation or turn that goes
constexpr double kFidelityInAll = 0.15;    // may be lost altogether

/// A labelling and what is wrong with it.
struct State {
    Labeling labels;
    std::vector<LabelCosts> extra;
    Layout layout;
    int violations = 0;
    int turns = 0;
    double energy = 0;
    double fidelity = 0;

    [[nodiscard]] std::tuple<int, int, double> rank() const { return {violations, turns, energy}; }
};

/// A change that helped where it was tried, with the facets it set.
struct Useful {
    double gain;
    Proposal proposal;
    std::vector<std::uint32_t> seeds;
};

class Search {
  public:
    Search(const Energy& energy, Labeling labels, const Run& run)
        : energy_(energy), facets_(energy.facets()), run_(run) {
        now_.labels = std::move(labels);
        now_.extra.assign(facets_.count(), LabelCosts{});
        measure(now_);
        first_fidelity_ = now_.fidelity;
    }

    Labeling best() {
        State best = now_;
        for (int round = 0; round < kMostRounds && !run_.cancelled(); ++round) {
            const bool done = now_.violations == 0 && now_.turns == 0;
            if (done || tried_ >= kMostProposals || !step()) {
                break;
            }
            if (now_.rank() < best.rank()) {
                best = now_;
            }
        }
        return best.labels;
    }

  private:
    void measure(State& state) const {
        state.layout = layout_of(facets_, state.labels);
        state.violations = state.layout.violations();
        state.turns = static_cast<int>(state.layout.turning_points.size());
        state.energy = energy_.of(state.labels);
        state.fidelity = fidelity(facets_, state.labels);
    }

    bool step() {
        useful_.clear();
        best_gain_ = kLeastGain;
        const Scene scene{energy_, now_.labels, now_.layout};
        const Consider consider = [&](const Proposal& proposal) { return weigh(proposal); };
        propose_for_charts(scene, consider);
        propose_for_opposites(scene, consider);
        propose_for_corners(scene, consider);
        if (now_.violations == 0) {
            propose_for_turns(scene, consider);
        }
        if (useful_.empty()) {
            return false;
        }
        accept();
        return true;
    }

    /// Takes the best change of the round, then others far from it that still help as much.
    void accept() {
        std::stable_sort(useful_.begin(), useful_.end(),
                         [](const Useful& a, const Useful& b) { return a.gain > b.gain; });
        std::vector<bool> touched(facets_.count(), false);
        const auto touch = [&](const std::vector<std::uint32_t>& seeds) {
            for (const auto f : grown(facets_, seeds, 2 * scaled_rings(facets_, kFreeRings))) {
                touched[f] = true;
            }
        };
        now_ = std::move(next_);
        touch(useful_.front().seeds);
        for (std::size_t i = 1; i < useful_.size() && !run_.cancelled(); ++i) {
            const Useful& other = useful_[i];
            if (std::any_of(other.seeds.begin(), other.seeds.end(),
                            [&](std::uint32_t f) { return touched[f]; })) {
                continue;
            }
            State state;
            if (try_out(other.proposal, state) != nullptr &&
                gain_of(other.proposal, state) > kStillUseful * other.gain) {
                now_ = std::move(state);
                touch(other.seeds);
            }
        }
    }

    /// Keeps the change if it helps, and its outcome if it is the best of the round; false: the
    /// budget is used up.
    bool weigh(const Proposal& proposal) {
        State state;
        if (const auto* seeds = try_out(proposal, state)) {
            const double gain = gain_of(proposal, state);
            if (gain > kLeastGain) {
                useful_.push_back({gain, proposal, *seeds});
            }
            if (gain > best_gain_) {
                best_gain_ = gain;
                next_ = std::move(state);
            }
        }
        return tried_ < kMostProposals && !run_.cancelled();
    }

    /// The state after a change, solved again nearby; the facets changed, or nothing where it
    /// changes nothing.
    const std::vector<std::uint32_t>* try_out(const Proposal& proposal, State& state) {
        ++tried_;
        state.labels = now_.labels;
        state.extra = now_.extra;
        seeds_ = apply(proposal, state);
        if (seeds_.empty()) {
            return nullptr;
        }
        lower(energy_, state.extra, grown(facets_, seeds_, scaled_rings(facets_, kFreeRings)),
              state.labels);
        if (state.labels == now_.labels) {
            return nullptr;
        }
        measure(state);
        return &seeds_;
    }

    /// Where a chart goes, what earlier changes laid on the other labels must not keep it.
    static void cap_others(LabelCosts& extra, AxisLabel label) {
        for (std::size_t l = 0; l < kLabelCount; ++l) {
            if (l != static_cast<std::size_t>(label)) {
                extra.at(l) = std::min(extra.at(l), kDeletionCap);
            }
        }
    }

    static std::vector<std::uint32_t> apply(const Proposal& proposal, State& state) {
        std::vector<std::uint32_t> seeds;
        for (const auto& [f, label] : proposal.forced) {
            for (std::size_t l = 0; l < kLabelCount; ++l) {
                state.extra[f].at(l) += kForce;
            }
            state.extra[f].at(static_cast<std::size_t>(label)) = 0;
            state.labels[f] = label;
            seeds.push_back(f);
        }
        for (const auto& [f, label] : proposal.forbidden) {
            LabelCosts& extra = state.extra[f];
            extra.at(static_cast<std::size_t>(label)) += kForce;
            if (proposal.deletes) {
                cap_others(extra, label);
            }
            seeds.push_back(f);
        }
        std::sort(seeds.begin(), seeds.end());
        seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
        return seeds;
    }

    /// What a change is worth, percent of the area; 0 where it mends nothing or costs too much.
    [[nodiscard]] double gain_of(const Proposal& proposal, const State& state) const {
        const int violations_gone = now_.violations - state.violations;
        const int turns_gone = now_.turns - state.turns;
        if (violations_gone < 0 || (violations_gone == 0 && turns_gone <= 0)) {
            return 0;
        }
        const double allowed =
            kFidelityPerStep * (std::max(0, violations_gone) + std::max(0, turns_gone));
        if (now_.fidelity - state.fidelity > allowed ||
            first_fidelity_ - state.fidelity > kFidelityInAll) {
            return 0;
        }
        const double price = proposal.deletes ? 1 : kConstructionPrice;
        return kViolationWorth * violations_gone + kTurnWorth * turns_gone -
               price * (state.energy - now_.energy);
    }

    const Energy& energy_;
    const Facets& facets_;
    const Run& run_;
    State now_;
    State next_;
    std::vector<Useful> useful_;
    std::vector<std::uint32_t> seeds_;
    double best_gain_ = 0;
    double first_fidelity_ = 0;
    int tried_ = 0;
};

}  // namespace

Labeling repaired(const Energy& energy, Labeling labels, const Run& run) {
    return Search(energy, std::move(labels), run).best();
}

Labeling thinned_out(const Energy& energy, Labeling labels, const Run& run) {
    constexpr int kRounds = 40;
    constexpr double kPenalty = 5;
    constexpr int kSeamRings = 3;
    const Facets& facets = energy.facets();
    std::vector<LabelCosts> extra(facets.count(), LabelCosts{});
    std::vector<std::uint32_t> all(facets.count());
    std::iota(all.begin(), all.end(), 0U);
    for (int round = 0; round < kRounds && !run.cancelled(); ++round) {
        const Layout layout = layout_of(facets, labels);
        if (layout.violations() == 0) {
            break;
        }
        bool deleted = false;
        for (std::uint32_t f = 0; f < facets.count(); ++f) {
            if (layout.charts[layout.chart_of[f]].deficiency > 0) {
                extra[f].at(static_cast<std::size_t>(labels[f])) += kPenalty;
                deleted = true;
            }
        }
        std::vector<std::uint32_t> seam;
        for (const auto b : layout.opposite) {
            const auto& facets_along = layout.boundaries[b].facets;
            seam.insert(seam.end(), facets_along.begin(), facets_along.end());
        }
        if (!deleted && seam.empty()) {
            break;  // only corners of many boundaries are left: nothing to delete
        }
        if (!deleted) {
            std::sort(seam.begin(), seam.end());
            seam.erase(std::unique(seam.begin(), seam.end()), seam.end());
            for (const auto f : grown(facets, seam, scaled_rings(facets, kSeamRings))) {
                extra[f].at(static_cast<std::size_t>(labels[f])) += kPenalty;
                extra[f].at(static_cast<std::size_t>(opposite(labels[f]))) += kPenalty;
            }
        }
        lower(energy, extra, all, labels);
    }
    return labels;
}

}  // namespace decomp::labels
