// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/values.h"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace tools {

decomp::Result<double> parse_length_mm(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, double>, 5> kUnits{
        {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4}, {"", 1}}};
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    while (!unit.empty() && unit.front() == ' ') {
        unit.remove_prefix(1);
    }
    for (const auto& [name, mm] : kUnits) {
        if (error == std::errc{} && unit == name && std::isfinite(value) && value > 0) {
            return value * mm;
        }
    }
    return decomp::fail("usage.length", "'" + std::string(text) + "' is no length above zero", {},
                        "write a number and a unit: 245mm, 24.5cm, 9.6in");
}

CLI::Option* add_length(CLI::App& app, const std::string& name, std::optional<double>& length_mm,
                        const std::string& description) {
    return app
        .add_option_function<std::string>(
            name,
            [&length_mm](const std::string& text) {
                const auto length = parse_length_mm(text);
                if (!length) {
                    throw CLI::ValidationError(length.error().message + "; " + length.error().hint);
                }
                length_mm = *length;
            },
            description)
        ->type_name("LENGTH");
}

std::string duration_text(double seconds) {
    const long total = std::lround(seconds);
    const auto two = [](long big, const char* big_unit, long small, const char* small_unit) {
        return std::to_string(big) + ' ' + big_unit + ' ' + std::to_string(small) + ' ' +
               small_unit;
    };
    if (total >= 3600) {
        return two(total / 3600, "h", total % 3600 / 60, "min");
    }
    return total >= 60 ? two(total / 60, "min", total % 60, "s") : std::to_string(total) + " s";
}

}  // namespace tools
