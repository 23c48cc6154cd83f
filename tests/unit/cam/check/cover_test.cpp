// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/cover.h"

#include "cam/check/cover_bound.h"
#include "decomp/base/rng.h"

#include <gtest/gtest.h>

#include <bit>
#include <numeric>

namespace {

using cam::check::Cover;
using cam::check::smallest_cover;

double covered(const std::vector<std::uint64_t>& masks, const std::vector<double>& weights,
               std::uint64_t set) {
    double sum = 0;
    for (std::size_t i = 0; i < masks.size(); ++i) {
        sum += (masks[i] & set) != 0 ? weights[i] : 0;
    }
    return sum;
}

TEST(Cover, IsSmallerThanGreedyWhereGreedyErrs) {
    // The classic: greedy takes the third set first and needs three, two suffice.
    const std::vector<std::uint64_t> masks{0b101, 0b101, 0b001, 0b110, 0b110, 0b010};
    const std::vector<double> weights(6, 1.0);
    const Cover cover = smallest_cover(masks, weights, {.enough = 1});
    EXPECT_EQ(cover.chosen.size(), 2U);
    EXPECT_TRUE(cover.smallest);
    EXPECT_EQ(cover.covered.back(), 6);
}

TEST(Cover, IsTheSmallestByExhaustion) {
    decomp::Rng rng(7);
    for (int round = 0; round < 40; ++round) {
        std::vector<std::uint64_t> masks;
        std::vector<double> weights;
        for (int i = 0; i < 60; ++i) {
            masks.push_back(rng.next() & rng.next() & 0x3FFU);
            weights.push_back(rng.uniform(0.1, 2));
        }
        const double all = covered(masks, weights, ~std::uint64_t{0});
        const Cover cover = smallest_cover(masks, weights, {.enough = 0.95});
        ASSERT_TRUE(cover.smallest);
        int fewest = 11;
        double most = 0;
        for (std::uint64_t set = 0; set < 1024; ++set) {
            if (covered(masks, weights, set) >= 0.95 * all - 1e-9) {
                fewest = std::min(fewest, std::popcount(set));
            }
        }
        for (std::uint64_t set = 0; set < 1024; ++set) {
            if (std::popcount(set) == fewest) {
                most = std::max(most, covered(masks, weights, set));
            }
        }
        EXPECT_EQ(static_cast<int>(cover.chosen.size()), fewest);
        EXPECT_EQ(cover.at_least, fewest);
        const Cover hasty = smallest_cover(masks, weights, {.enough = 0.95, .most_nodes = 0});
        EXPECT_LE(hasty.at_least, fewest);
        EXPECT_GE(static_cast<int>(hasty.chosen.size()), fewest);
        EXPECT_NEAR(cover.covered.back(), most, 1e-9);
        EXPECT_NEAR(cover.coverable, all, 1e-9);
    }
}

TEST(Cover, ASmallBudgetSaysThatNothingIsProvedAndStillCovers) {
    decomp::Rng rng(3);
    std::vector<std::uint64_t> masks;
    for (int i = 0; i < 3000; ++i) {
        masks.push_back(rng.next() & rng.next() & rng.next() & rng.next());
    }
    const std::vector<double> weights(masks.size(), 1.0);
    const Cover cover = smallest_cover(masks, weights, {.enough = 0.99, .most_nodes = 50});
    EXPECT_FALSE(cover.smallest);
    EXPECT_LT(cover.at_least, static_cast<int>(cover.chosen.size()));
    EXPECT_GT(cover.at_least, 10);  // a bit covers a sixteenth, so eleven never cover 0.99
    EXPECT_GE(cover.covered.back(), 0.99 * cover.coverable);
}

TEST(Cover, PricesBoundWhatAnySetCovers) {
    decomp::Rng rng(11);
    for (int round = 0; round < 20; ++round) {
        std::vector<cam::check::CoverGroup> groups;
        for (int i = 0; i < 80; ++i) {
            groups.push_back({rng.next() & rng.next() & 0x3FFU, rng.uniform(0.1, 2)});
        }
        for (int size = 1; size <= 5; ++size) {
            double most = 0;
            for (std::uint64_t set = 0; set < 1024; ++set) {
                double sum = 0;
                for (const auto& group : groups) {
                    sum += (group.mask & set) != 0 ? group.weight : 0;
                }
                most = std::popcount(set) == size ? std::max(most, sum) : most;
            }
            const auto prices = cam::check::low_prices(groups, {.size = size, .wanted = most});
            const double gains = cam::check::largest_sum(cam::check::gains_of(groups, 0), size, 0);
            EXPECT_GE(prices.bound, most - 1e-9);
            EXPECT_LE(prices.bound, gains + 1e-9)
                << "prices of the whole weight are the first tried";
        }
    }
}

TEST(Cover, NothingToCoverNeedsNothing) {
    EXPECT_TRUE(smallest_cover({0, 0}, {1, 1}, {}).chosen.empty());
    EXPECT_TRUE(smallest_cover({}, {}, {}).chosen.empty());
}

TEST(Cover, EqualGainsGoToTheLowerBit) {
    const Cover cover = smallest_cover({0b11000, 0b00110}, {1, 1}, {.enough = 1});
    EXPECT_EQ(cover.chosen, (std::vector<int>{1, 3}));
}

}  // namespace
