// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/words.h"

#include <cctype>
#include <charconv>
#include <cmath>

namespace cam::stream {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

bool takes_text(std::string_view command) {
    for (const std::string_view word : {"M117", "M118", "M23", "M28", "M30 ", "M32", "M16"}) {
        if (command.size() > word.size() && command.starts_with(word) &&
            std::isdigit(static_cast<unsigned char>(command[word.size()])) == 0) {
            return true;
        }
    }
    return false;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_space(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

std::string without_comments(std::string_view line) {
    std::string out;
    int depth = 0;
    for (const char c : line) {
        if (c == ';' && depth == 0) {
            break;
        }
        if (c == '(') {
            ++depth;
        } else if (c == ')' && depth > 0) {
            --depth;
        } else if (depth == 0 && c != '%') {
            out += c;
        }
    }
    return out;
}

std::string_view without_number(std::string_view text) {
    if (text.size() > 1 && (text[0] == 'N' || text[0] == 'n')) {
        std::size_t end = 1;
        while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) {
            ++end;
        }
        if (end > 1) {
            text = trimmed(text.substr(end));
        }
    }
    return text.substr(0,
                       text.rfind('*') == std::string_view::npos ? text.size() : text.rfind('*'));
}

}  // namespace

const Word* Words::find(char letter) const {
    for (const Word& word : *this) {
        if (word.letter == letter) {
            return &word;
        }
    }
    return nullptr;
}

bool Words::has(char letter, double value) const {
    for (const Word& word : *this) {
        if (word.letter == letter && !word.bare && word.value == value) {
            return true;
        }
    }
    return false;
}

Words read_words(std::string_view line) {
    Words out;
    std::string_view rest = without_number(trimmed(line));
    while (true) {
        rest = trimmed(rest);
        if (rest.empty()) {
            return out;
        }
        const auto letter =
            static_cast<char>(std::toupper(static_cast<unsigned char>(rest.front())));
        if (letter < 'A' || letter > 'Z' || out.count == Words::kMost) {
            out.readable = false;
            return out;
        }
        rest = trimmed(rest.substr(1));
        Word word{letter, 0, true};
        std::string_view number = rest;
        number.remove_prefix(number.starts_with('+') ? 1 : 0);
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(),
                                                  word.value, std::chars_format::fixed);
        if (error == std::errc::result_out_of_range || std::abs(word.value) > Words::kLargest) {
            out.readable = false;
            return out;
        }
        if (error == std::errc{} && std::isfinite(word.value)) {
            word.bare = false;
            rest = number.substr(static_cast<std::size_t>(end - number.data()));
        }
        out.words.at(out.count++) = word;
    }
}

std::string bare_line(std::string_view line) {
    const std::string text = without_comments(line);
    const std::string_view core = trimmed(without_number(trimmed(text)));
    if (takes_text(core)) {
        return std::string(core);
    }
    std::string out;
    for (const char c : core) {
        if (!is_space(c)) {
            out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        }
    }
    return out;
}

std::string comment_of(std::string_view line) {
    std::string out;
    int depth = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == ';' && depth == 0) {
            out += out.empty() ? "" : " ";
            out += trimmed(line.substr(i + 1));
            break;
        }
        if (c == '(') {
            depth += 1;
            out += out.empty() ? "" : " ";
        } else if (c == ')' && depth > 0) {
            depth -= 1;
        } else if (depth > 0) {
            out += c;
        }
    }
    return out;
}

}  // namespace cam::stream
