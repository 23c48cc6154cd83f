// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/cover.h"

#include <algorithm>
#include <array>
#include <utility>

namespace cam::check {

namespace {

constexpr int kBits = 64;
constexpr double kSameGain = 1e-12;  // of everything

struct Group {
    std::uint64_t mask;
    double weight;
};

std::vector<Group> groups_of(const std::vector<std::uint64_t>& masks,
                             const std::vector<double>& weights) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < masks.size(); ++i) {
        if (masks[i] != 0) {
            order.push_back(i);
        }
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return masks[a] < masks[b]; });
    std::vector<Group> groups;
    for (const std::size_t i : order) {
        if (groups.empty() || groups.back().mask != masks[i]) {
            groups.push_back({masks[i], 0});
        }
        groups.back().weight += weights[i];
    }
    return groups;
}

using Gains = std::array<double, kBits>;

/// What each bit would add to what `taken` covers.
Gains gains_of(const std::vector<Group>& groups, std::uint64_t taken) {
    Gains gains{};
    for (const Group& group : groups) {
        if ((group.mask & taken) != 0) {
            continue;
        }
        for (std::uint64_t left = group.mask; left != 0; left &= left - 1) {
            gains.at(static_cast<std::size_t>(__builtin_ctzll(left))) += group.weight;
        }
    }
    return gains;
}

double covered_by(const std::vector<Group>& groups, std::uint64_t taken) {
    double sum = 0;
    for (const Group& group : groups) {
        sum += (group.mask & taken) != 0 ? group.weight : 0;
    }
    return sum;
}

std::vector<int> by_gain(const Gains& gains, double same) {
    std::vector<int> order;
    for (int bit = 0; bit < kBits; ++bit) {
        if (gains.at(static_cast<std::size_t>(bit)) > same) {
            order.push_back(bit);
        }
    }
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return gains.at(static_cast<std::size_t>(a)) > gains.at(static_cast<std::size_t>(b));
    });
    return order;
}

std::vector<int> greedy(const std::vector<Group>& groups, double wanted, double same) {
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

/// Depth first over sets of a fixed size; gains only fall as a set grows, so the sum of the largest
/// gains of today bounds what the places left can add.
class Search {
  public:
    Search(const std::vector<Group>& groups, double wanted, double same, std::size_t budget)
        : groups_(groups), wanted_(wanted), same_(same), budget_(budget) {}

    /// @return a set of `size` bits that covers enough, or none
    [[nodiscard]] std::vector<int> run(int size) {
        best_.clear();
        best_covered_ = wanted_;
        std::vector<int> set;
        extend(set, 0, 0, 0, size);
        return best_;
    }

    [[nodiscard]] bool exhausted() const { return nodes_ <= budget_; }

  private:
    void extend(std::vector<int>& set, std::uint64_t taken, std::uint64_t barred, double covered,
                int left) {
        if (left == 0) {
            if (covered > best_covered_ || (best_.empty() && covered >= wanted_)) {
                best_ = set;
                best_covered_ = covered;
            }
            return;
        }
        if (++nodes_ > budget_) {
            return;
        }
        Gains gains = gains_of(groups_, taken);
        for (int bit = 0; bit < kBits; ++bit) {
            if ((barred >> bit & 1U) != 0) {
                gains.at(static_cast<std::size_t>(bit)) = 0;
            }
        }
        const std::vector<int> order = by_gain(gains, same_);
        for (std::size_t i = 0; i < order.size(); ++i) {
            double bound = covered;
            for (std::size_t k = i; k < order.size() && k < i + static_cast<std::size_t>(left);
                 ++k) {
                bound += gains.at(static_cast<std::size_t>(order[k]));
            }
            if (bound < best_covered_ || nodes_ > budget_) {
                return;
            }
            const std::uint64_t bit = std::uint64_t{1} << order[i];
            set.push_back(order[i]);
            extend(set, taken | bit, barred, covered + gains.at(static_cast<std::size_t>(order[i])),
                   left - 1);
            set.pop_back();
            barred |= bit;  // sets with it have all been seen
        }
    }

    const std::vector<Group>& groups_;
    double wanted_;
    double same_;
    std::size_t budget_;
    std::size_t nodes_ = 0;
    std::vector<int> best_;
    double best_covered_ = 0;
};

/// The order in which each bit adds most, for the same set.
std::vector<int> by_contribution(const std::vector<Group>& groups, std::vector<int> set) {
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
    const std::vector<Group> groups = groups_of(masks, weights);
    Cover cover;
    cover.coverable = covered_by(groups, ~std::uint64_t{0});
    const double same = kSameGain * cover.coverable;
    const double wanted = options.enough * cover.coverable - same;
    std::vector<int> best = greedy(groups, wanted, same);
    Search search(groups, wanted, same, options.most_nodes);
    // Sizes from below: the first that can be met is the smallest.
    for (int size = 1; size <= static_cast<int>(best.size()) && search.exhausted(); ++size) {
        const std::vector<int> found = search.run(size);
        if (!found.empty()) {
            best = found;
            break;
        }
    }
    cover.smallest = search.exhausted();
    cover.chosen = by_contribution(groups, best);
    std::uint64_t taken = 0;
    for (const int bit : cover.chosen) {
        taken |= std::uint64_t{1} << bit;
        cover.covered.push_back(covered_by(groups, taken));
    }
    return cover;
}

}  // namespace cam::check
