// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace decomp::io {

inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

inline char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

inline bool equals_ignoring_case(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) {
        return false;
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (lower(a[i]) != lower(b[i])) {
            return false;
        }
    }
    return true;
}

/// Reads a whole text as a number, whatever the locale. Too small for a double is 0; too large,
/// infinity.
inline bool to_number(std::string_view text, double& out) {
    if (!text.empty() && text.front() == '+') {
        text.remove_prefix(1);
    }
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    if (error == std::errc::result_out_of_range && end == text.data() + text.size()) {
        const bool small = text.find("e-") != std::string_view::npos ||
                           text.find("E-") != std::string_view::npos ||
                           text.find_first_of("eE") == std::string_view::npos;
        out = small ? 0.0 : std::numeric_limits<double>::infinity();
        return true;
    }
    return error == std::errc{} && end == text.data() + text.size();
}

inline bool to_integer(std::string_view text, std::int64_t& out) {
    if (!text.empty() && text.front() == '+') {
        text.remove_prefix(1);
    }
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc{} && end == text.data() + text.size();
}

/// Walks over text by words or by lines. The line number is counted only when an error needs it.
class TextScanner {
  public:
    TextScanner(std::string_view text, std::string_view name, char comment = '#')
        : text_(text), name_(name), comment_(comment) {}

    /// The next word across lines, comments skipped; empty at the end.
    std::string_view word() {
        skip_to_word(true);
        return take_word();
    }

    /// The next word of this line; empty at its end.
    std::string_view word_in_line() {
        skip_to_word(false);
        return take_word();
    }

    /// Goes to the start of the next line; false at the end of the text.
    bool next_line() {
        while (at_ < text_.size() && text_[at_] != '\n') {
            ++at_;
        }
        at_ += at_ < text_.size() ? 1 : 0;
        return at_ < text_.size();
    }

    void skip_to(std::size_t offset) { at_ = offset < text_.size() ? offset : text_.size(); }

    bool number(double& out) { return to_number(word(), out); }

    bool integer(std::int64_t& out) { return to_integer(word(), out); }

    [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }

    [[nodiscard]] std::size_t rest() const { return text_.size() - at_; }

    [[nodiscard]] std::size_t offset() const { return at_; }

    /// "name:line" of the word read last.
    [[nodiscard]] std::string where() const {
        std::size_t line = 1;
        for (std::size_t i = 0; i < word_at_ && i < text_.size(); ++i) {
            line += text_[i] == '\n' ? 1 : 0;
        }
        return std::string(name_) + ":" + std::to_string(line);
    }

    [[nodiscard]] tl::unexpected<Error> error(std::string code, std::string message,
                                              std::string hint = {}) const {
        return fail(std::move(code), std::move(message), where(), std::move(hint));
    }

    /// For a number that could not be read: the file ends here, or holds something else.
    [[nodiscard]] tl::unexpected<Error> expected(std::string_view what) const {
        if (word_at_ >= text_.size()) {
            return error("io.truncated",
                         "the file ends where " + std::string(what) + " should follow",
                         "save or download the file again");
        }
        return error("io.syntax",
                     "found '" + shown_word() + "' where " + std::string(what) + " should stand");
    }

  private:
    void skip_to_word(bool across_lines) {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == comment_) {
                while (at_ < text_.size() && text_[at_] != '\n') {
                    ++at_;
                }
            } else if (is_blank(c) || (c == '\n' && across_lines)) {
                ++at_;
            } else {
                return;
            }
        }
    }

    std::string_view take_word() {
        word_at_ = at_;
        while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n') {
            ++at_;
        }
        return text_.substr(word_at_, at_ - word_at_);
    }

    /// The word read last, fit for a message: short and printable.
    [[nodiscard]] std::string shown_word() const {
        constexpr std::size_t kLongest = 24;
        std::string out;
        for (std::size_t i = word_at_; i < at_ && out.size() < kLongest; ++i) {
            out += text_[i] > ' ' && text_[i] <= '~' ? text_[i] : '?';
        }
        return out.empty() ? std::string("the end of the line") : out;
    }

    std::string_view text_;
    std::string_view name_;
    std::size_t at_ = 0;
    std::size_t word_at_ = 0;
    char comment_;
};

}  // namespace decomp::io
