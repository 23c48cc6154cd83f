// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cam::post {

/// Prints moves with the least words: axes that do not move and feeds that do not change are left
/// out. All values live on the grid of the dialect's last decimal, so what is printed adds up to
/// what was meant, whatever the number of moves.
class GcodeWriter {
  public:
    explicit GcodeWriter(profile::Dialect dialect);

    /// Text as it is; must not move the axes X, Y, Z unless forget() follows.
    void raw(std::string_view text);

    /// One comment line.
    void comment(std::string_view text);

    /// After foreign text that moves: every axis and the feed are written again.
    void forget();

    /// A travel when no filament is fed. Always G1: some firmwares and converters run G0 at the
    /// machine's highest speed, whatever F says.
    void move_xy(const Eigen::Vector2d& to, double filament_mm, double speed_mm_per_s);
    void move_z(double z_mm, double speed_mm_per_s);
    void feed_filament(double filament_mm, double speed_mm_per_s);

    /// Absolute E only: what was fed so far is called zero.
    void filament_was_reset() { zero_e_ = written_e_; }

    [[nodiscard]] std::string take() && { return std::move(text_); }

  private:
    enum Axis { X, Y, Z };

    bool word(Axis axis, double value_mm);
    bool filament_word();
    void end(double speed_mm_per_s, std::size_t undo_to, bool moved);
    [[nodiscard]] std::int64_t total_e_grid() const;
    void append_grid(std::int64_t grid, int decimals);

    profile::Dialect dialect_;
    std::string text_;
    std::array<std::optional<std::int64_t>, 3> at_;
    std::optional<std::int64_t> feed_;
    double total_e_mm_ = 0;  ///< all filament fed, exactly as asked
    std::int64_t written_e_ =
        0;                     ///< of it, what the text says so far, in units of the last decimal
    std::int64_t zero_e_ = 0;  ///< where absolute E counts from
};

}  // namespace cam::post
