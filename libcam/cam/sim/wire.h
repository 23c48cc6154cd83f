// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/faults.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace cam::sim {

/// The line between host and board: bytes take their time at the baud rate, and faults befall them.
class Wire {
  public:
    /// @param baud  bits a second, ten for a byte; 0: no time at all
    Wire(Faults faults, long baud);

    void from_host(std::string_view bytes, Time now);
    void from_board(std::string_view bytes, Time now);

    /// What has arrived by `now`.
    [[nodiscard]] std::string to_board(Time now) { return taken(out_, now); }

    [[nodiscard]] std::string to_host(Time now) { return taken(in_, now); }

    [[nodiscard]] std::optional<Time> next() const;

    /// The cable is out: what is under way is lost.
    void cut();

    /// Ends of lines that the host has sent.
    [[nodiscard]] long host_lines() const { return host_lines_; }

    /// True once for every time that the script says so.
    [[nodiscard]] bool unplug_due();
    [[nodiscard]] bool reset_due();

    [[nodiscard]] const Faults& faults() const { return faults_; }

    [[nodiscard]] long flipped_lines() const { return flipped_lines_; }

    [[nodiscard]] long flipped_bytes() const { return flipped_bytes_; }

    [[nodiscard]] long lost_acks() const { return lost_acks_; }

  private:
    struct Direction {
        std::deque<std::pair<Time, std::string>> pieces;
        Time busy_until{};
    };

    void put(Direction& direction, std::string bytes, Time now, Time delay = Time{});
    std::string taken(Direction& direction, Time now);
    void disturb(std::string& line, double flip_line, double flip_byte, double drop_byte);
    std::uint64_t random();
    bool chance(double rate);

    Faults faults_;
    long baud_;
    std::uint64_t state_;
    Direction out_;
    Direction in_;
    std::string answer_;  ///< of the board, up to the end of the line
    long host_lines_ = 0;
    long unplugged_at_ = 0;
    std::size_t resets_ = 0;
    long flipped_lines_ = 0;
    long flipped_bytes_ = 0;
    long lost_acks_ = 0;
};

}  // namespace cam::sim
