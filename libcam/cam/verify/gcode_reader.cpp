// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/gcode_reader.h"

#include <cstdint>

namespace cam::verify {
namespace {

constexpr double kLargestNumber = 1e7;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

enum class Number { None, Good, Bad };

/// Reads [+-]digits[.digits] at `at`. G-code knows no exponent: "1E5" is X1 followed by E5.
Number read_number(std::string_view text, std::size_t& at, double& value) {
    static constexpr std::array<double, 19> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                                       1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                                       1e14, 1e15, 1e16, 1e17, 1e18};
    std::size_t i = at;
    while (i < text.size() && is_space(text[i])) {
        ++i;
    }
    bool negative = false;
    const std::size_t sign_at = i;
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) {
        negative = text[i] == '-';
        ++i;
    }
    std::uint64_t digits = 0;
    std::size_t decimals = 0;
    std::size_t seen = 0;
    bool huge = false;
    bool point = false;
    for (; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '.' && !point) {
            point = true;
        } else if (is_digit(c)) {
            ++seen;
            if (digits < 100000000000000000ULL) {
                digits = digits * 10 + static_cast<std::uint64_t>(c - '0');
                decimals += point ? 1 : 0;
            } else if (!point) {
                huge = true;
            }
        } else {
            break;
        }
    }
    if (seen == 0) {
        return i == sign_at ? Number::None : Number::Bad;
    }
    at = i;
    value = static_cast<double>(digits) / kPowers[decimals];
    if (negative) {
        value = -value;
    }
    return huge || value > kLargestNumber || value < -kLargestNumber ? Number::Bad : Number::Good;
}

/// Commands whose arguments are free text.
bool takes_text(char letter, double code) {
    if (letter != 'M') {
        return false;
    }
    const int m = static_cast<int>(code);
    return m == 16 || m == 23 || m == 28 || m == 30 || m == 32 || m == 36 || m == 70 || m == 117 ||
           m == 118 || m == 136 || m == 137 || m == 486 || m == 862;
}

void read_words(GcodeLine& line, std::string_view text) {
    std::size_t at = 0;
    line.kind = GcodeLine::Kind::Command;
    while (at < text.size()) {
        const char c = text[at];
        if (is_space(c)) {
            ++at;
            continue;
        }
        if (c == ';' || c == '*') {
            break;
        }
        if (c == '(') {
            const std::size_t close = text.find(')', at);
            at = close == std::string_view::npos ? text.size() : close + 1;
            continue;
        }
        if (!is_letter(c)) {
            line.kind = GcodeLine::Kind::Malformed;
            return;
        }
        Word word;
        word.letter = upper(c);
        ++at;
        const Number read = read_number(text, at, word.value);
        if (read == Number::Bad) {
            line.kind = GcodeLine::Kind::Malformed;
            return;
        }
        word.has_value = read == Number::Good;
        if (word.letter == 'N' && line.count == 0) {
            continue;
        }
        const bool command = word.letter == 'G' || word.letter == 'M' || word.letter == 'T';
        if (line.count == 0 && (!command || !word.has_value)) {
            line.kind = GcodeLine::Kind::Foreign;
            return;
        }
        if (line.count == GcodeLine::kMaxWords) {
            line.kind = GcodeLine::Kind::Malformed;
            return;
        }
        line.words[line.count++] = word;
        if (takes_text(word.letter, word.value)) {
            return;
        }
    }
    if (line.count == 0) {
        line.kind = GcodeLine::Kind::Empty;
    }
}

}  // namespace

const Word* GcodeLine::find(char letter) const {
    for (std::size_t i = 1; i < count; ++i) {
        if (words[i].letter == letter) {
            return &words[i];
        }
    }
    return nullptr;
}

double GcodeLine::value(char letter, double otherwise) const {
    const Word* word = find(letter);
    return word != nullptr && word->has_value ? word->value : otherwise;
}

bool GcodeReader::next(GcodeLine& line) {
    if (rest_.empty()) {
        return false;
    }
    ++number_;
    const std::size_t end = rest_.find('\n');
    std::string_view text = rest_.substr(0, end);
    rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
    while (!text.empty() && is_space(text.back())) {
        text.remove_suffix(1);
    }
    line.text = text;
    line.count = 0;
    line.comment = {};
    line.kind = GcodeLine::Kind::Empty;
    std::size_t start = 0;
    while (start < text.size() && is_space(text[start])) {
        ++start;
    }
    if (start == text.size() || text[start] == '%') {
        return true;
    }
    if (const std::size_t semicolon = text.find(';'); semicolon != std::string_view::npos) {
        line.comment = text.substr(semicolon + 1);
        text = text.substr(0, semicolon);
        if (semicolon == start) {
            return true;
        }
    }
    if (!is_letter(text[start]) && text[start] != '(') {
        line.kind = GcodeLine::Kind::Unreadable;
        return true;
    }
    read_words(line, text);
    return true;
}

}  // namespace cam::verify
