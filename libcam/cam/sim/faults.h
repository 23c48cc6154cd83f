// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/board.h"

#include <tl/expected.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cam::sim {

/// What goes wrong on a line. "out" is towards the board. Rates are probabilities, 0 .. 1.
struct Faults {
    std::uint64_t seed = 1;
    double flip_line_out = 0;  ///< of a line to have one byte changed
    double flip_line_in = 0;
    double flip_byte_out = 0;  ///< of every byte to be changed
    double flip_byte_in = 0;
    double drop_byte_out = 0;
    double drop_byte_in = 0;
    double drop_ack = 0;    ///< of an answer "ok…" to be lost
    double double_ack = 0;  ///< … to come twice
    double delay_ack = 0;   ///< … to come late
    Time delay{};
    long unplug_every = 0;       ///< lines; 0: never
    Time unplugged{};            ///< for how long
    std::vector<long> reset_at;  ///< lines after which the board is reset
};

/// Reads a script, one fault a line, '#' begins a comment:
///   seed 7
///   flip line 0.01 out        flip byte 0.001 in        drop byte 0.001 both
///   drop ack 0.01             double ack 0.001          delay ack 0.001 40ms
///   unplug every 10000 for 200ms
///   reset at 5000
/// @return the faults, or one sentence with the line that cannot be read
[[nodiscard]] tl::expected<Faults, std::string> read_faults(std::string_view script);

}  // namespace cam::sim
