// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <CLI/App.hpp>
#include <Eigen/Core>

#include <optional>
#include <string>
#include <string_view>

namespace tools {

/// "245mm", "24.5cm", "0.245m", "9.6in" or "245" as millimetres. @error usage.length
[[nodiscard]] decomp::Result<double> parse_length_mm(std::string_view text);

/// A length option: checked while parsing, stored in millimetres.
CLI::Option* add_length(CLI::App& app, const std::string& name, std::optional<double>& length_mm,
                        const std::string& description);

/// "100x100x80mm" as millimetres: three lengths, the last unit holds for those without one.
/// @error usage.length
[[nodiscard]] decomp::Result<Eigen::Vector3d> parse_size_mm(std::string_view text);

/// A size option: checked while parsing, stored in millimetres.
CLI::Option* add_size(CLI::App& app, const std::string& name,
                      std::optional<Eigen::Vector3d>& size_mm, const std::string& description);

/// "1 h 23 min", "4 min 10 s"
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace tools
