// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/cover.h"

#include "cam/check/cover_bound.h"

#include <algorithm>
#include <array>
#include <utility>

namespace cam::check {

namespace {

constexpr double kSameGain = 1e-12;  // of everything

std::vector<CoverGroup> groups_of(const std::vector<std::uint64_t>& masks,
                                  const std::vector<double>& weights) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < masks.size(); ++i) {
        if (masks[i] != 0) {
            order.push_back(i);
        }
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return masks[a] < masks[b]; });
    std::vector<CoverGroup> groups;
    for (const std::size_t i : order) {
        if (groups.empty() || groups.back().mask != masks[i]) {
            groups.push_back({masks[i], 0});
        }
        groups.back().weight += weights[i];
    }
    return groups;
}

double covered_by(const std::vector<CoverGroup>& groups, std::uint64_t taken) {
    double sum = 0;
    for (const CoverGroup& group : groups) {
        sum += (group.mask & taken) != 0 ? group.weight : 0;
    }
    return sum;
}

std::vector<int> by_gain(const Gains& gains, double same) {
    std::vector<int> order;
    for (int bit = 0; bit < kCoverBits; ++bit) {
        if (gains.at(static_cast<std::size_t>(bit)) > same) {
            order.push_back(bit);
        }
    }
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return gains.at(static_cast<std::size_t>(a)) > gains.at(static_cast<std::size_t>(b));
    });
    return order;
}

std::vector<int> greedy(const std::vector<CoverGroup>& groups, double wanted, double same) {
    std::vector<int> chosen;
    std::uint64_t taken = 0;
    double covered = 0;
    while (covered < wanted) {
        const Gains gains = gains_of(groups, taken);
        const std::vector<int> order = by_gain(gains, same);
        if (order.empty()) {
            break;
        }
        chosen.push_back(order.front());
        taken |= std::uint64_t{1} << order.front();
        covered += gains.at(static_cast<std::size_t>(order.front()));
    }
    return chosen;
}

struct Aim {
    double wanted = 0;      ///< weight to be covered
    double same = 0;        ///< smaller gains are none
    std::size_t nodes = 0;  ///< of the search
};

/// Depth first over sets of a fixed size; gains only fall as a set grows, so the sum of the largest
/// gains of today bounds what the places left can add, and so do the prices of cover_bound.h.
class Search {
  public:
    Search(const std::vector<CoverGroup>& groups, const Aim& aim)
        : groups_(groups), wanted_(aim.wanted), same_(aim.same), budget_(aim.nodes) {}

    /// @return a set of `size` bits that covers enough, or none
    [[nodiscard]] std::vector<int> run(int size) {
        best_.clear();
        best_covered_ = wanted_;
        const Prices prices = low_prices(groups_, {.size = size, .wanted = wanted_});
        refuted_ = prices.bound < wanted_;
        if (refuted_ || nodes_ > budget_) {
            return best_;
        }
        priced_ = groups_;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            priced_[g].weight = prices.price[g];
        }
        std::vector<int> set;
        extend(set, 0, 0, 0, size);
        refuted_ = best_.empty() && nodes_ <= budget_;
        return best_;
    }

    /// Whether no set of the last size covers enough, for certain.
    [[nodiscard]] bool refuted() const { return refuted_; }

  private:
    /// What sets that hold `taken`, `left` more bits and none that is barred cover at most.
    [[nodiscard]] double priced_bound(std::uint64_t taken, std::uint64_t barred, double covered,
                                      int left) const {
        double unpaid = 0;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            unpaid += (groups_[g].mask & taken) == 0 ? groups_[g].weight - priced_[g].weight : 0;
        }
        return covered + unpaid + largest_sum(gains_of(priced_, taken), left, barred);
    }

    void take(const std::vector<int>& set, double covered) {
        if (covered > best_covered_ || (best_.empty() && covered >= wanted_)) {
            best_ = set;
            best_covered_ = covered;
        }
    }

    void extend(std::vector<int>& set, std::uint64_t taken, std::uint64_t barred, double covered,
                int left) {
        if (left == 0) {
            take(set, covered);
            return;
        }
        if (++nodes_ > budget_) {
            return;
        }
        if (left > 1 && priced_bound(taken, barred, covered, left) < best_covered_) {
            return;
        }
        const Gains gains = gains_of(groups_, taken);
        for (const int bit : by_gain(gains, same_)) {
            const double gain = gains.at(static_cast<std::size_t>(bit));
            if ((barred >> bit & 1U) != 0) {
                continue;
            }
            if (covered + largest_sum(gains, left, barred) < best_covered_ || nodes_ > budget_) {
                return;
            }
            set.push_back(bit);
            extend(set, taken | std::uint64_t{1} << bit, barred, covered + gain, left - 1);
            set.pop_back();
            barred |= std::uint64_t{1} << bit;  // sets with it have all been seen
        }
    }

    const std::vector<CoverGroup>& groups_;
    std::vector<CoverGroup> priced_;
    double wanted_;
    double same_;
    std::size_t budget_;
    std::size_t nodes_ = 0;
    bool refuted_ = false;
    std::vector<int> best_;
    double best_covered_ = 0;
};

/// The order in which each bit adds most, for the same set.
std::vector<int> by_contribution(const std::vector<CoverGroup>& groups, std::vector<int> set) {
    std::sort(set.begin(), set.end());
    std::vector<int> out;
    std::uint64_t taken = 0;
    while (!set.empty()) {
        const Gains gains = gains_of(groups, taken);
        const auto next = std::max_element(set.begin(), set.end(), [&](int a, int b) {
            return gains.at(static_cast<std::size_t>(a)) < gains.at(static_cast<std::size_t>(b));
        });
        taken |= std::uint64_t{1} << *next;
        out.push_back(*next);
        set.erase(next);
    }
    return out;
}

}  // namespace

Cover smallest_cover(const std::vector<std::uint64_t>& masks, const std::vector<double>& weights,
                     const CoverOptions& options) {
    const std::vector<CoverGroup> groups = groups_of(masks, weights);
    Cover cover;
    cover.coverable = covered_by(groups, ~std::uint64_t{0});
    const double same = kSameGain * cover.coverable;
    const double wanted = options.enough * cover.coverable - same;
    std::vector<int> best = greedy(groups, wanted, same);
    Search search(groups, {.wanted = wanted, .same = same, .nodes = options.most_nodes});
    // Sizes from below: the first that can be met is the smallest.
    const auto most = static_cast<int>(best.size());
    for (cover.at_least = std::min(1, most); cover.at_least <= most; ++cover.at_least) {
        std::vector<int> found = search.run(cover.at_least);
        if (!found.empty()) {
            best = std::move(found);
        }
        if (cover.at_least == static_cast<int>(best.size()) || !search.refuted()) {
            break;
        }
    }
    cover.smallest = cover.at_least == static_cast<int>(best.size());
    cover.chosen = by_contribution(groups, best);
    std::uint64_t taken = 0;
    for (const int bit : cover.chosen) {
        taken |= std::uint64_t{1} << bit;
        cover.covered.push_back(covered_by(groups, taken));
    }
    return cover;
}

}  // namespace cam::check
