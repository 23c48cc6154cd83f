// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace cam::verify {

/// A letter and its number, e.g. X12.5. `has_value` is false for a bare letter ("G28 X").
struct Word {
    char letter = 0;  ///< upper case
    double value = 0;
    bool has_value = false;
};

/// One line of a program, taken apart. Views point into the program.
struct GcodeLine {
    enum class Kind {
        Empty,    ///< nothing, or only a comment
        Command,  ///< words, the first of which is a G, M or T word
        Foreign,  ///< a word that is no G, M or T: a macro's name or a parameter without a command
        Malformed,  ///< a number that cannot be read or is beyond 1e7
        Unreadable  ///< no G-code at all: bytes that no dialect allows
    };

    static constexpr std::size_t kMaxWords = 24;

    Kind kind = Kind::Empty;
    std::array<Word, kMaxWords> words{};
    std::size_t count = 0;
    std::string_view comment;  ///< what follows ';', without it
    std::string_view text;     ///< the whole line without its end

    /// First word with this letter after the command; null when there is none.
    [[nodiscard]] const Word* find(char letter) const;

    /// Value of find(letter), or `otherwise` when it is absent or bare.
    [[nodiscard]] double value(char letter, double otherwise) const;
};

/// Splits a program into lines, reading words of every line: optional line numbers (N12), checksums
/// (*71), comments
/// (";" and "( )"), any case, with or without spaces. Never throws, whatever the bytes. O(length).
class GcodeReader {
  public:
    explicit GcodeReader(std::string_view program) : rest_(program) {}

    /// The next line, or false at the end. The line is valid until the next call.
    [[nodiscard]] bool next(GcodeLine& line);

    /// 1-based number of the line last returned.
    [[nodiscard]] long number() const { return number_; }

  private:
    std::string_view rest_;
    long number_ = 0;
};

}  // namespace cam::verify
