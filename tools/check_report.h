// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/fdm.h"
#include "tools/check_input.h"
#include "tools/verb.h"

#include <string>
#include <string_view>
#include <vector>

namespace tools {

/// A table on the terminal: columns as wide as their longest cell, the first to the left.
class TextTable {
  public:
    explicit TextTable(std::vector<std::string> head) : rows_{std::move(head)} {}

    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

    [[nodiscard]] std::string text() const;

  private:
    std::vector<std::vector<std::string>> rows_;
};

[[nodiscard]] Json share_json(const cam::check::Share& share);
[[nodiscard]] Json vector_json(const Eigen::Vector3d& vector);

/// "12.3": a percentage as tables have it.
[[nodiscard]] std::string percent_text(double percent);

/// "-z", "x", or "0.12 -0.99 0.05".
[[nodiscard]] std::string direction_text(const Eigen::Vector3d& direction);

/// "x", "-z" or "0.1,-0.9,0" as a direction of any length. @error usage.direction
[[nodiscard]] decomp::Result<Eigen::Vector3d> parse_direction(const std::string& text);

/// The parts of one job by one process: rows, totals, and what is drawn of each part.
[[nodiscard]] decomp::Result<Answer> check_printing(const CheckRequest& request,
                                                    const CheckInput& input, decomp::Run& run);
[[nodiscard]] decomp::Result<Answer> check_three_axes(const CheckRequest& request,
                                                      const CheckInput& input, decomp::Run& run);
[[nodiscard]] decomp::Result<Answer> check_four_axes(const CheckRequest& request,
                                                     const CheckInput& input, decomp::Run& run);

}  // namespace tools
