// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"
#include "decomp/base/result.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// The small language of templates: `{name}` and `{expression}` with numbers, names, + - * / ( ),
/// min(a, b) and max(a, b). `{{` stands for a brace. It has no loops, no conditions and no way to
/// reach anything but its values.
namespace cam::profile {

using TemplateValues = std::map<std::string, std::variant<double, std::string>, std::less<>>;

/// The text with every placeholder replaced; numbers have at most three decimals.
/// @error profile.template_name (with the nearest name), profile.template_syntax
[[nodiscard]] decomp::Result<std::string> expand(std::string_view text,
                                                 const TemplateValues& values);

/// Where a placeholder has a value.
enum class Scope { Program, Layer, Heater, Fan, Position, Progress, Dwell };

struct Placeholder {
    Scope scope = Scope::Program;
    std::string name;
    std::string doc;
    bool is_text = false;
};

/// Every name that templates may use. Scope::Program names are known in the start, layer and end
/// templates, those of Scope::Layer in the layer template as well, the others each in their own
/// template of the dialect.
[[nodiscard]] const std::vector<Placeholder>& placeholders();

/// What is wrong with a template before anything is known of the job: nothing, or one error.
[[nodiscard]] std::optional<decomp::Error> template_fault(std::string_view text,
                                                          const std::vector<Scope>& scopes);

struct ForbiddenWord {
    std::string word;  ///< as the dialect lists it
    long line = 0;     ///< 1-based
};

/// The first word of a program that its dialect forbids; comments are skipped, "M0109" and
/// "m109S60" are M109.
[[nodiscard]] std::optional<ForbiddenWord> first_forbidden_word(std::string_view program,
                                                                const Dialect& dialect);

}  // namespace cam::profile
