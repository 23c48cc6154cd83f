// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/protocol.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cam::protocol {

/// One line from firmware of the Marlin family (Marlin, Prusa's, Repetier, Teacup).
struct MarlinReply {
    enum class Kind {
        Ok,
        Resend,     ///< `number`: the line that it wants
        LineFault,  ///< checksum or line number; `number`: the last line that it has, if told
        Fatal,      ///< halted, thermal fault, failed homing
        Fault,      ///< any other "Error:"
        Banner,     ///< the board has started
        Wait,       ///< nothing to do
        Busy,
        WaitsForUser,  ///< paused until the operator does something at the machine
        Report,        ///< temperatures or position alone
        Firmware,      ///< the answer to M115
        Capability,
        Action,  ///< "//action:…"; `text`: what follows the colon
        Text     ///< anything else
    };

    Kind kind = Kind::Text;
    std::string_view text;
    std::optional<long> number;        ///< of a line
    std::optional<int> planner_free;   ///< "P15"
    std::optional<int> commands_free;  ///< "B3"
    std::vector<Heater> heaters;
    std::optional<AxisValues> position_mm;  ///< "X: Y: Z: E:"; NaN where absent
    std::optional<double> feed_percent;     ///< "FR:110%"
};

/// Reads one line without its end. Whatever the bytes: never throws. O(length).
[[nodiscard]] MarlinReply read_marlin_reply(std::string_view line);

/// `KEY:value` of the answer to M115, up to the next KEY: or the end; empty when absent.
[[nodiscard]] std::string firmware_field(std::string_view line, std::string_view key);

/// The exclusive or of all bytes, as Marlin's checksum.
[[nodiscard]] int marlin_checksum(std::string_view text);

/// "N<number> <text>*<checksum>\n"
[[nodiscard]] std::string numbered_line(long number, std::string_view text);

}  // namespace cam::protocol
