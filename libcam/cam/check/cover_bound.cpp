// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/cover_bound.h"

#include <algorithm>
#include <bit>
#include <functional>

namespace cam::check {

namespace {

constexpr double kStep = 1.0;        // of the step that would reach the wanted bound on a slope
constexpr double kShorter = 0.7;     // when the bound has not fallen for some rounds
constexpr int kPatience = 8;         // rounds
constexpr double kShortest = 0.002;  // steps below change nothing

std::vector<std::size_t> dearest(const Gains& gains, int size) {
    std::vector<std::size_t> order(gains.size());
    for (std::size_t bit = 0; bit < order.size(); ++bit) {
        order[bit] = bit;
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return gains.at(a) > gains.at(b); });
    order.resize(static_cast<std::size_t>(std::min(size, kCoverBits)));
    return order;
}

}  // namespace

Gains gains_of(const std::vector<CoverGroup>& groups, std::uint64_t taken) {
    Gains gains{};
    for (const CoverGroup& group : groups) {
        if ((group.mask & taken) != 0) {
            continue;
        }
        for (std::uint64_t left = group.mask; left != 0; left &= left - 1) {
            gains.at(static_cast<std::size_t>(std::countr_zero(left))) += group.weight;
        }
    }
    return gains;
}

double largest_sum(const Gains& gains, int size, std::uint64_t barred) {
    Gains sorted{};
    for (std::size_t bit = 0; bit < gains.size(); ++bit) {
        sorted.at(bit) = (barred >> bit & 1U) != 0 ? 0 : gains.at(bit);
    }
    const auto places = static_cast<std::ptrdiff_t>(std::min(size, kCoverBits));
    std::partial_sort(sorted.begin(), sorted.begin() + places, sorted.end(), std::greater<>());
    double sum = 0;
    for (auto it = sorted.begin(); it != sorted.begin() + places; ++it) {
        sum += *it;
    }
    return sum;
}

Prices low_prices(const std::vector<CoverGroup>& groups, const PriceOptions& options) {
    std::vector<CoverGroup> priced = groups;
    Prices best;
    double step = kStep;
    int stale = 0;
    for (int round = 0; round < options.rounds && step > kShortest; ++round) {
        const Gains gains = gains_of(priced, 0);
        std::uint64_t set = 0;
        for (const std::size_t bit : dearest(gains, options.size)) {
            set |= std::uint64_t{1} << bit;
        }
        double bound = largest_sum(gains, options.size, 0);
        double slope = 0;
        for (std::size_t g = 0; g < groups.size(); ++g) {
            bound += groups[g].weight - priced[g].weight;
            const int over = std::popcount(groups[g].mask & set) - 1;
            slope += groups[g].weight * over * over;
        }
        if (best.price.empty() || bound < best.bound) {
            stale = 0;
            best.bound = bound;
            best.price.resize(groups.size());
            std::transform(priced.begin(), priced.end(), best.price.begin(),
                           [](const CoverGroup& group) { return group.weight; });
        } else if (++stale % kPatience == 0) {
            step *= kShorter;
        }
        if (best.bound < options.wanted || slope <= 0) {
            break;
        }
        // Groups that are paid for more than once become cheaper, those not bought dearer; each in
        // proportion to its weight.
        const double turn = step * std::max(0.0, bound - options.wanted) / slope;
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const int over = std::popcount(groups[g].mask & set) - 1;
            priced[g].weight = std::clamp(priced[g].weight - turn * groups[g].weight * over, 0.0,
                                          groups[g].weight);
        }
    }
    return best;
}

}  // namespace cam::check
