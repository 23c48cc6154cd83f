// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace cam::stream {

/// A letter and its number.
struct Word {
    char letter = 0;  ///< upper case
    double value = 0;
    bool bare = false;  ///< no number follows: "G28 X"
};

/// The words of one line, in order.
struct Words {
    static constexpr std::size_t kMost = 32;
    static constexpr double kLargest = 1e7;  ///< no machine is told a larger number

    std::array<Word, kMost> words{};
    std::size_t count = 0;
    bool readable =
        true;  ///< false: something is no word, a number is too large, or there are too many

    [[nodiscard]] const Word* begin() const { return words.data(); }

    [[nodiscard]] const Word* end() const { return words.data() + count; }

    /// The first word with this letter; null when there is none.
    [[nodiscard]] const Word* find(char letter) const;

    /// Whether this command is among the words: has('G', 53), has('G', 59.3).
    [[nodiscard]] bool has(char letter, double value) const;
};

/// Takes a line apart that has no comments; spaces, case and a line number do not matter.
/// O(length).
[[nodiscard]] Words read_words(std::string_view line);

/// The line as it is sent: comments (";…", "(…)"), line number, checksum, '%' and outer spaces are
/// gone. Inner spaces go too, and letters become capitals, unless a text follows the command
/// (M117 and the like).
[[nodiscard]] std::string bare_line(std::string_view line);

/// What the comments of a line say, joined.
[[nodiscard]] std::string comment_of(std::string_view line);

}  // namespace cam::stream
