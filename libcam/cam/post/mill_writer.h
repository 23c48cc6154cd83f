// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/mill_machine.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cam::post {

/// Prints moves of a mill with the least words, on the grid of the dialect's last decimal.
class MillWriter {
  public:
    MillWriter(profile::MillDialect dialect, double rapid_mm_per_min);

    /// Lines as they are; must not move.
    void raw(std::string_view text);

    /// A comment, split into lines that the dialect takes; brackets and bytes beyond ASCII are
    /// replaced.
    void comment(std::string_view text);

    /// Every axis and the feed are written again: nobody knows where a change of tool ends.
    void forget();

    /// Up before across, across before down.
    void rapid(const Eigen::Vector3d& to);
    void line(const Eigen::Vector3d& to, double mm_per_min);

    /// The shorter way round, at most 180 degrees, on the dialect's grid.
    void half_arc(const Eigen::Vector3d& to, const Eigen::Vector2d& centre, bool clockwise,
                  double mm_per_min);

    /// Whether these points are one in print.
    [[nodiscard]] bool same_in_print(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

    [[nodiscard]] bool knows_position() const { return at_[0] && at_[1] && at_[2]; }

    [[nodiscard]] bool knows_height() const { return at_[2].has_value(); }

    [[nodiscard]] Eigen::Vector3d position() const;

    /// The first line longer than the dialect allows; 0: none. 1-based.
    [[nodiscard]] long long_line() const { return long_line_; }

    [[nodiscard]] std::string take() && { return std::move(text_); }

  private:
    std::string word(int axis, double value_mm);
    void feed_word(std::string& line, double mm_per_min);
    void put(const std::string& line);
    [[nodiscard]] std::int64_t grid(double value_mm) const;
    [[nodiscard]] std::string printed(std::int64_t on_grid) const;

    profile::MillDialect dialect_;
    double rapid_mm_per_min_;
    double scale_ = 1000;
    std::string text_;
    std::array<std::optional<std::int64_t>, 3> at_;
    std::optional<std::int64_t> feed_;
    long lines_ = 0;
    long long_line_ = 0;
};

}  // namespace cam::post
