// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// How much a set of directions of a given size can cover at most.
namespace cam::check {

inline constexpr int kCoverBits = 64;

/// All facets that are seen from the same directions.
struct CoverGroup {
    std::uint64_t mask = 0;
    double weight = 0;
};

using Gains = std::array<double, kCoverBits>;

/// What each bit would add to what `taken` covers.
[[nodiscard]] Gains gains_of(const std::vector<CoverGroup>& groups, std::uint64_t taken);

/// Sum of the `size` largest entries whose bit is not barred.
[[nodiscard]] double largest_sum(const Gains& gains, int size, std::uint64_t barred);

/// Prices at which directions buy groups, 0 to the group's weight each. However they are set,
///     sum over groups (weight - price) + sum of the `size` dearest directions
/// is more than any `size` directions cover: a group that is covered twice pays twice its price.
/// (The Lagrangian dual of maximum coverage: Fisher, Management Science 27, 1981.)
struct Prices {
    std::vector<double> price;
    double bound = 0;  ///< for sets of `size` bits
};

struct PriceOptions {
    int size = 1;
    double wanted = 0;  ///< a bound below it ends the search
    int rounds = 200;
};

/// Prices that make the bound small: subgradient steps from prices equal to weights. A counted
/// number of rounds, O(groups * bits) each; deterministic.
[[nodiscard]] Prices low_prices(const std::vector<CoverGroup>& groups, const PriceOptions& options);

}  // namespace cam::check
