// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/protocol.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace cam::protocol {

/// One line from Grbl 1.1, grblHAL or FluidNC.
struct GrblReply {
    enum class Kind {
        Ok,
        Error,   ///< `number`
        Alarm,   ///< `number`
        Status,  ///< "<…>"
        Banner,
        Version,  ///< [VER:…]; `text`: what follows the colon
        Options,  ///< [OPT:…]
        Axes,     ///< [AXS:4:XYZA]; `text`: the letters
        Offset,   ///< [G54:…]; `text`: the name, `values`
        Setting,  ///< $130=200.0; `number`, `values[0]`
        Message,  ///< [MSG:…], and every other […]
        Garbled   ///< nothing that this firmware says
    };

    Kind kind = Kind::Garbled;
    std::string_view text;
    int number = 0;
    AxisValues values{};
    int count = 0;  ///< of values

    // Of a status report:
    std::string_view state;  ///< "Run", "Hold:0"
    bool has_machine_position = false;
    bool has_work_position = false;
    AxisValues position{};  ///< in the unit of reports
    int axes = 0;
    std::optional<AxisValues> work_offset;  ///< WCO
    std::optional<double> feed_override;
    std::optional<std::pair<int, int>> buffers;  ///< free planner blocks, free bytes
};

/// Reads one line without its end. Whatever the bytes: never throws. O(length).
[[nodiscard]] GrblReply read_grbl_reply(std::string_view line);

/// "error:20" in words; never empty.
[[nodiscard]] std::string grbl_error_words(int number);

/// "ALARM:1" in words; never empty.
[[nodiscard]] std::string grbl_alarm_words(int number);

}  // namespace cam::protocol
