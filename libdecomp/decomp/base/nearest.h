// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace decomp {

/// Insertions, deletions, replacements and swaps of neighbours that turn one word into the other
/// (optimal string alignment distance). Cost O(a.size() * b.size()).
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);

/// The candidate which somebody who typed `word` most likely meant: the nearest one, at a distance
/// of at most a third of the word (and at least 2), or else the only one that contains the word.
/// Ties go to the first. Empty: none.
[[nodiscard]] std::string nearest_word(std::string_view word,
                                       const std::vector<std::string>& candidates);

/// "did you mean 'x'?", or an empty text.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& candidates);

}  // namespace decomp
