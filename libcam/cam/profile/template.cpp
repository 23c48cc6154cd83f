// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/template.h"

#include "decomp/base/nearest.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace cam::profile {

using decomp::fail;
using decomp::Result;

namespace {

/// Recursive descent over one expression:
///   sum = product { ("+" | "-") product }     product = atom { ("*" | "/") atom }
///   atom = number | name | "-" atom | "(" sum ")" | ("min" | "max") "(" sum "," sum ")"
class Expression {
  public:
    Expression(std::string_view text, const TemplateValues& values)
        : text_(text), values_(values) {}

    Result<std::string> evaluate() {
        // A name alone may stand for a text; within arithmetic only numbers make sense.
        const std::string name = trimmed();
        const auto found = values_.find(name);
        if (found != values_.end() && std::holds_alternative<std::string>(found->second)) {
            return std::get<std::string>(found->second);
        }
        const Result<double> value = sum(0);
        if (!value) {
            return fail(value.error());
        }
        skip_spaces();
        if (at_ != text_.size()) {
            return syntax("unexpected '" + std::string(text_.substr(at_)) + "'");
        }
        if (!std::isfinite(*value) || std::abs(*value) >= 1e9) {
            return syntax("the result is no usable number");
        }
        return decomp::decimal(*value, 3);
    }

  private:
    [[nodiscard]] std::string trimmed() const {
        const std::size_t first = text_.find_first_not_of(' ');
        const std::size_t last = text_.find_last_not_of(' ');
        return first == std::string_view::npos ? std::string()
                                               : std::string(text_.substr(first, last - first + 1));
    }

    [[nodiscard]] tl::unexpected<decomp::Error> syntax(const std::string& what) const {
        return fail("profile.template_syntax", what + " in {" + std::string(text_) + "}", {},
                    "placeholders are names, numbers, + - * / ( ), min(a, b) and max(a, b)");
    }

    void skip_spaces() {
        while (at_ < text_.size() && text_[at_] == ' ') {
            ++at_;
        }
    }

    bool take(char c) {
        skip_spaces();
        if (at_ < text_.size() && text_[at_] == c) {
            ++at_;
            return true;
        }
        return false;
    }

    Result<double> sum(int depth) {
        Result<double> value = product(depth);
        while (value) {
            const bool plus = take('+');
            if (!plus && !take('-')) {
                break;
            }
            Result<double> other = product(depth);
            if (!other) {
                return other;
            }
            *value += plus ? *other : -*other;
        }
        return value;
    }

    Result<double> product(int depth) {
        Result<double> value = atom(depth);
        while (value) {
            const bool times = take('*');
            if (!times && !take('/')) {
                break;
            }
            Result<double> other = atom(depth);
            if (!other) {
                return other;
            }
            if (!times && *other == 0) {
                return syntax("division by zero");
            }
            *value = times ? *value * *other : *value / *other;
        }
        return value;
    }

    Result<double> atom(int depth) {
        constexpr int kDeepest = 32;
        if (depth > kDeepest) {
            return syntax("too many parentheses");
        }
        skip_spaces();
        if (take('-')) {
            return atom(depth + 1).map([](double value) { return -value; });
        }
        if (take('(')) {
            return closed(sum(depth + 1));
        }
        if (at_ < text_.size() &&
            (std::isdigit(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '.')) {
            return number();
        }
        const std::string name = word();
        if (name.empty()) {
            return syntax("a name or a number is missing");
        }
        if ((name == "min" || name == "max") && take('(')) {
            return smaller_or_larger(name == "min", depth);
        }
        return named(name);
    }

    Result<double> closed(Result<double> value) {
        if (value && !take(')')) {
            return syntax("')' is missing");
        }
        return value;
    }

    Result<double> smaller_or_larger(bool smaller, int depth) {
        Result<double> a = sum(depth + 1);
        if (!a) {
            return a;
        }
        if (!take(',')) {
            return syntax("',' is missing");
        }
        Result<double> b = closed(sum(depth + 1));
        if (!b) {
            return b;
        }
        return smaller ? std::min(*a, *b) : std::max(*a, *b);
    }

    Result<double> number() {
        double value = 0;
        const char* begin = text_.data() + at_;
        const auto [end, error] =
            std::from_chars(begin, text_.data() + text_.size(), value, std::chars_format::fixed);
        if (error != std::errc{}) {
            return syntax("bad number");
        }
        at_ += static_cast<std::size_t>(end - begin);
        return value;
    }

    std::string word() {
        const std::size_t begin = at_;
        while (at_ < text_.size() &&
               (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_')) {
            ++at_;
        }
        return std::string(text_.substr(begin, at_ - begin));
    }

    [[nodiscard]] Result<double> named(const std::string& name) const {
        const auto found = values_.find(name);
        if (found == values_.end()) {
            std::vector<std::string> known;
            for (const auto& [key, value] : values_) {
                known.push_back(key);
            }
            return fail("profile.template_name", "unknown placeholder '" + name + "'", {},
                        decomp::did_you_mean(name, known));
        }
        if (!std::holds_alternative<double>(found->second)) {
            return syntax("'" + name + "' is a text and cannot be computed with");
        }
        return std::get<double>(found->second);
    }

    std::string_view text_;
    const TemplateValues& values_;
    std::size_t at_ = 0;
};

/// "m0109" -> "M109"; the letter and its number without leading zeros.
std::string normal_word(std::string_view letter_and_digits) {
    std::string out(
        1, static_cast<char>(std::toupper(static_cast<unsigned char>(letter_and_digits.front()))));
    std::size_t first = 1;
    while (first + 1 < letter_and_digits.size() && letter_and_digits[first] == '0' &&
           std::isdigit(static_cast<unsigned char>(letter_and_digits[first + 1])) != 0) {
        ++first;
    }
    out += letter_and_digits.substr(first);
    return out;
}

/// The first forbidden word of one line, comments left out.
std::string forbidden_in_line(std::string_view line, const Dialect& dialect) {
    int depth = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (depth == 0 && line.substr(i).starts_with(dialect.comment)) {
            break;
        }
        depth += line[i] == '(' ? 1 : 0;
        depth -= line[i] == ')' && depth > 0 ? 1 : 0;
        if (depth > 0 || std::isalpha(static_cast<unsigned char>(line[i])) == 0) {
            continue;
        }
        std::size_t end = i + 1;
        while (end < line.size() &&
               (std::isdigit(static_cast<unsigned char>(line[end])) != 0 || line[end] == '.')) {
            ++end;
        }
        const std::string word = normal_word(line.substr(i, end - i));
        for (const std::string& forbidden : dialect.forbidden) {
            if (!forbidden.empty() && word == normal_word(forbidden)) {
                return forbidden;
            }
        }
        i = end - 1;
    }
    return {};
}

}  // namespace

Result<std::string> expand(std::string_view text, const TemplateValues& values) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '{') {
            out += text[i];
            continue;
        }
        if (i + 1 < text.size() && text[i + 1] == '{') {
            out += '{';
            ++i;
            continue;
        }
        const std::size_t end = text.find('}', i);
        if (end == std::string_view::npos) {
            return fail("profile.template_syntax", "'}' is missing", {}, "write {{ for a brace");
        }
        Result<std::string> value = Expression(text.substr(i + 1, end - i - 1), values).evaluate();
        if (!value) {
            return value;
        }
        out += *value;
        i = end;
    }
    return out;
}

const std::vector<Placeholder>& placeholders() {
    static const std::vector<Placeholder> table = {
        {Scope::Program, "title", "what is printed", true},
        {Scope::Program, "material", "name of the material", true},
        {Scope::Program, "nozzle_celsius", "from the second layer on"},
        {Scope::Program, "first_layer_nozzle_celsius", "of the first layer"},
        {Scope::Program, "bed_celsius", "of the bed"},
        {Scope::Program, "nozzle_diameter_mm", "bore of the nozzle"},
        {Scope::Program, "filament_diameter_mm", "of the filament"},
        {Scope::Program, "retraction_length_mm", "filament pulled back before a travel"},
        {Scope::Program, "travel_feed_mm_per_min", "speed between beads"},
        {Scope::Program, "first_layer_height_mm", "of the first layer"},
        {Scope::Program, "chamber_min_x_mm", "lowest X of the chamber"},
        {Scope::Program, "chamber_min_y_mm", "lowest Y of the chamber"},
        {Scope::Program, "chamber_max_x_mm", "highest X of the chamber"},
        {Scope::Program, "chamber_max_y_mm", "highest Y of the chamber"},
        {Scope::Program, "chamber_max_z_mm", "highest Z of the chamber"},
        {Scope::Program, "print_min_x_mm", "lowest X of any bead"},
        {Scope::Program, "print_min_y_mm", "lowest Y of any bead"},
        {Scope::Program, "print_max_x_mm", "highest X of any bead"},
        {Scope::Program, "print_max_y_mm", "highest Y of any bead"},
        {Scope::Program, "print_max_z_mm", "top of the last layer"},
        {Scope::Program, "layer_count", "number of layers"},
        {Scope::Layer, "layer", "number of this layer, from 0"},
        {Scope::Layer, "z_mm", "height of the nozzle in this layer"},
        {Scope::Layer, "height_mm", "thickness of this layer"},
        {Scope::Heater, "celsius", "temperature to set"},
        {Scope::Fan, "fan_0_255", "speed of the fan, 0 .. 255"},
        {Scope::Fan, "fan_fraction", "speed of the fan, 0 .. 1"},
        {Scope::Position, "x_mm", "where the nozzle is"},
        {Scope::Position, "y_mm", "where the nozzle is"},
        {Scope::Position, "z_mm", "where the nozzle is"},
        {Scope::Progress, "percent", "of the time that has passed, 0 .. 100"},
        {Scope::Progress, "minutes_left", "until the end, rounded"},
        {Scope::Dwell, "milliseconds", "to wait"},
    };
    return table;
}

std::optional<decomp::Error> template_fault(std::string_view text,
                                            const std::vector<Scope>& scopes) {
    TemplateValues values;
    for (const Placeholder& placeholder : placeholders()) {
        if (std::find(scopes.begin(), scopes.end(), placeholder.scope) != scopes.end()) {
            if (placeholder.is_text) {
                values[placeholder.name] = std::string("text");
            } else {
                values[placeholder.name] = 1.0;
            }
        }
    }
    const Result<std::string> expanded = expand(text, values);
    if (expanded) {
        return std::nullopt;
    }
    return expanded.error();
}

std::optional<ForbiddenWord> first_forbidden_word(std::string_view program,
                                                  const Dialect& dialect) {
    if (dialect.forbidden.empty()) {
        return std::nullopt;
    }
    long number = 1;
    for (std::size_t begin = 0; begin < program.size(); ++number) {
        const std::size_t end = std::min(program.find('\n', begin), program.size());
        const std::string word = forbidden_in_line(program.substr(begin, end - begin), dialect);
        if (!word.empty()) {
            return ForbiddenWord{word, number};
        }
        begin = end + 1;
    }
    return std::nullopt;
}

}  // namespace cam::profile
