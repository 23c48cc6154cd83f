// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/values.h"

#include <algorithm>
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

decomp::Result<Eigen::Vector3d> parse_size_mm(std::string_view text) {
    constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvw yz";
    const std::size_t unit_at = text.find_last_not_of(kLetters) + 1;
    const std::string unit(text.substr(std::min(unit_at, text.size())));
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    std::string_view rest = text;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t cross = rest.find('x');
        std::string one(rest.substr(0, cross));
        if (!one.empty() && one.find_first_of(kLetters) == std::string::npos) {
            one += unit;
        }
        const auto length = parse_length_mm(one);
        if (!length || (axis < 2) == (cross == std::string_view::npos)) {
            return decomp::fail("usage.length", "'" + std::string(text) + "' is no size", {},
                                "write three lengths and a unit: 100x100x80mm");
        }
        out[axis] = *length;
        rest.remove_prefix(cross == std::string_view::npos ? rest.size() : cross + 1);
    }
    return out;
}

CLI::Option* add_size(CLI::App& app, const std::string& name,
                      std::optional<Eigen::Vector3d>& size_mm, const std::string& description) {
    return app
        .add_option_function<std::string>(
            name,
            [&size_mm](const std::string& text) {
                const auto size = parse_size_mm(text);
                if (!size) {
                    throw CLI::ValidationError(size.error().message + "; " + size.error().hint);
                }
                size_mm = *size;
            },
            description)
        ->type_name("SIZE");
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
