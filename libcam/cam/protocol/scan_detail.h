// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>

/// Reading numbers out of replies; nothing here throws, whatever the bytes.
namespace cam::protocol::detail {

/// Beyond all that a machine measures or sets.
inline constexpr double kFarthest = 1e7;

/// The number at the beginning of `text`, taken off it; nothing when there is none or it is out of
/// range. Fractions have no exponent, and "nan", "inf" or more than kFarthest is none: a disturbed
/// line says anything.
template <class Number>
[[nodiscard]] std::optional<Number> take_number(std::string_view& text) {
    Number value{};
    std::from_chars_result read{};
    if constexpr (std::is_floating_point_v<Number>) {
        read = std::from_chars(text.data(), text.data() + text.size(), value,
                               std::chars_format::fixed);
        if (!(std::abs(value) <= kFarthest)) {
            return std::nullopt;
        }
    } else {
        read = std::from_chars(text.data(), text.data() + text.size(), value);
    }
    if (read.ec != std::errc{}) {
        return std::nullopt;
    }
    text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
    return value;
}

inline void skip_spaces(std::string_view& text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) {
        text.remove_prefix(1);
    }
}

/// True when `text` begins with the word, which is taken off it.
[[nodiscard]] inline bool take_word(std::string_view& text, std::string_view word) {
    if (!text.starts_with(word)) {
        return false;
    }
    text.remove_prefix(word.size());
    return true;
}

[[nodiscard]] inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Printable ASCII, or part of UTF-8 text.
[[nodiscard]] inline bool is_text(std::string_view text) {
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if ((byte < 0x20 && c != '\t') || byte == 0x7F) {
            return false;
        }
    }
    return true;
}

}  // namespace cam::protocol::detail
