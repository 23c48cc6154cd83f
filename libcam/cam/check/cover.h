// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cam::check {

struct CoverOptions {
    double enough = 0.995;            ///< share of what can be covered at all
    std::size_t most_nodes = 200000;  ///< of the search for a smaller set than the greedy one
};

/// A small set of directions that together see what can be seen.
struct Cover {
    std::vector<int> chosen;      ///< bits of the masks, the one that adds most first
    std::vector<double> covered;  ///< weight after each of them
    double coverable = 0;         ///< weight of everything with a bit at all
    int at_least = 0;             ///< proved: no set of fewer covers enough
    bool smallest = false;        ///< proved: there are `at_least` of them
};

/// The smallest set of bits such that the weights of the masks that it meets reach `enough` of the
/// weights of all masks with any bit; of several smallest, the one that covers most that the search
/// meets. Greedy first, then branch and bound over smaller sets within a counted budget, with
/// Lagrangian bounds (cover_bound.h); where the budget ends, `at_least` says how far the proof got.
/// Equal gains: the lower bit. Masks of equal value are one.
[[nodiscard]] Cover smallest_cover(const std::vector<std::uint64_t>& masks,
                                   const std::vector<double>& weights, const CoverOptions& options);

}  // namespace cam::check
