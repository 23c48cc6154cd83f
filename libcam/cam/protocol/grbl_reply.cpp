// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/grbl_reply.h"

#include "cam/protocol/scan_detail.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cam::protocol {

using detail::take_number;
using detail::take_word;

namespace {

constexpr std::array<std::string_view, 7> kStates = {"Idle",  "Run",  "Hold", "Jog",
                                                     "Alarm", "Door", "Check"};
constexpr std::array<std::string_view, 3> kMoreStates = {"Home", "Sleep", "Tool"};

/// "1.000,2.000,-3": how many numbers; 0 when it is anything else.
int read_values(std::string_view text, AxisValues& values) {
    int count = 0;
    while (true) {
        const auto value = take_number<double>(text);
        if (!value || !std::isfinite(*value) || count == static_cast<int>(kMaxAxes)) {
            return 0;
        }
        values.at(static_cast<std::size_t>(count++)) = *value;
        if (text.empty()) {
            return count;
        }
        if (!take_word(text, ",")) {
            return 0;
        }
    }
}

bool is_state(std::string_view state) {
    const std::string_view name = state.substr(0, state.find(':'));
    return std::find(kStates.begin(), kStates.end(), name) != kStates.end() ||
           std::find(kMoreStates.begin(), kMoreStates.end(), name) != kMoreStates.end();
}

bool read_field(std::string_view field, GrblReply& reply) {
    const std::size_t colon = field.find(':');
    if (colon == std::string_view::npos) {
        return !field.empty();
    }
    const std::string_view name = field.substr(0, colon);
    const std::string_view text = field.substr(colon + 1);
    AxisValues values{};
    if (name == "MPos" || name == "WPos") {
        reply.axes = read_values(text, reply.position);
        reply.has_machine_position = name == "MPos";
        reply.has_work_position = name == "WPos";
        return reply.axes > 0;
    }
    if (name == "WCO") {
        if (read_values(text, values) == 0) {
            return false;
        }
        reply.work_offset = values;
    } else if (name == "Ov") {
        if (read_values(text, values) != 3) {
            return false;
        }
        reply.feed_override = values[0] / 100;
    } else if (name == "Bf") {
        if (read_values(text, values) != 2) {
            return false;
        }
        reply.buffers = {static_cast<int>(std::clamp(values[0], -1.0, 1e6)),
                         static_cast<int>(std::clamp(values[1], -1.0, 1e6))};
    }
    return true;
}

/// "<Idle|MPos:0.000,0.000,0.000|FS:0,0>"
bool read_status(std::string_view line, GrblReply& reply) {
    if (!line.starts_with('<') || !line.ends_with('>') || line.size() < 3) {
        return false;
    }
    line = line.substr(1, line.size() - 2);
    reply.state = line.substr(0, line.find('|'));
    if (!is_state(reply.state)) {
        return false;
    }
    line.remove_prefix(reply.state.size());
    while (take_word(line, "|")) {
        const std::string_view field = line.substr(0, line.find('|'));
        if (!read_field(field, reply)) {
            return false;
        }
        line.remove_prefix(field.size());
    }
    reply.kind = GrblReply::Kind::Status;
    return true;
}

bool is_offset_name(std::string_view name) {
    return name == "G28" || name == "G30" || name == "G92" || name == "TLO" ||
           (name.size() == 3 && name.starts_with("G5") && name[2] >= '4' && name[2] <= '9');
}

void read_bracket(std::string_view line, GrblReply& reply) {
    using Kind = GrblReply::Kind;
    line = line.substr(1, line.size() - 2);
    reply.kind = Kind::Message;
    reply.text = line;
    std::string_view rest = line;
    if (take_word(rest, "VER:")) {
        reply.kind = Kind::Version;
        reply.text = rest;
    } else if (take_word(rest, "OPT:")) {
        reply.kind = Kind::Options;
        reply.text = rest;
    } else if (take_word(rest, "AXS:")) {
        reply.kind = Kind::Axes;
        reply.text = rest.substr(std::min(rest.size(), rest.find(':') + 1));
    } else if (take_word(rest, "MSG:")) {
        reply.text = rest;
    } else if (const std::size_t colon = line.find(':');
               colon != std::string_view::npos && is_offset_name(line.substr(0, colon))) {
        reply.count = read_values(line.substr(colon + 1), reply.values);
        reply.text = line.substr(0, colon);
        reply.kind = reply.count > 0 ? Kind::Offset : Kind::Garbled;
    }
}

bool read_numbered(std::string_view line, std::string_view word, GrblReply& reply) {
    if (!take_word(line, word)) {
        return false;
    }
    const auto number = take_number<int>(line);
    reply.number = number.value_or(0);
    return number.has_value() && line.empty();
}

}  // namespace

GrblReply read_grbl_reply(std::string_view line) {
    using Kind = GrblReply::Kind;
    GrblReply reply;
    while (!line.empty() && line.back() == ' ') {
        line.remove_suffix(1);
    }
    reply.text = line;
    if (line == "ok") {
        reply.kind = Kind::Ok;
    } else if (read_numbered(line, "error:", reply)) {
        reply.kind = Kind::Error;
    } else if (read_numbered(line, "ALARM:", reply)) {
        reply.kind = Kind::Alarm;
    } else if (line.starts_with("Grbl ") || line.starts_with("GrblHAL ") ||
               line.starts_with("grblHAL ")) {
        reply.kind = detail::is_text(line) ? Kind::Banner : Kind::Garbled;
    } else if (line.starts_with('[') && line.ends_with(']') && line.size() > 2 &&
               detail::is_text(line)) {
        read_bracket(line, reply);
    } else if (line.starts_with('>') && line.ends_with(":ok")) {
        reply.kind = Kind::Message;
    } else if (line.starts_with('$')) {
        std::string_view rest = line.substr(1);
        const auto number = take_number<int>(rest);
        if (number && take_word(rest, "=")) {
            reply.number = *number;
            const auto value = take_number<double>(rest);
            reply.values[0] = value.value_or(0);
            reply.count = value ? 1 : 0;
            reply.kind = Kind::Setting;
        } else if (detail::is_text(line) && line.find('=') != std::string_view::npos) {
            // Start-up lines ("$N0=") and FluidNC's named settings.
            reply.kind = Kind::Message;
        }
    } else {
        (void)read_status(line, reply);
    }
    return reply;
}

std::string grbl_error_words(int number) {
    static constexpr std::array<std::string_view, 39> kWords = {
        "",
        "a word does not begin with a letter",
        "a number is missing or unreadable",
        "a $ command is not known or not supported",
        "a negative value where only positive ones are allowed",
        "homing is not enabled",
        "a step pulse shorter than 3 microseconds",
        "the settings could not be read from memory and were restored",
        "a $ command that needs the machine to be idle",
        "G-code is locked out while alarmed or jogging",
        "soft limits need homing to be enabled",
        "the line has too many characters",
        "the setting asks for more steps a second than the controller can make",
        "the safety door is open",
        "the line is too long for the memory it should be stored in",
        "a jog target leaves the travel",
        "a jog command without = or with a forbidden word",
        "laser mode needs a spindle with speed control",
        "",
        "",
        "a G-code that the machine does not support",
        "two commands of one modal group in a line",
        "no feed rate was set",
        "a command that needs a whole number",
        "two commands in a line that both want axis words",
        "a word stands twice",
        "a command without the axis words it needs",
        "a line number out of range",
        "a command without the value it needs",
        "a work coordinate system that does not exist",
        "G53 is only allowed with G0 and G1",
        "axis words without a command that uses them",
        "an arc without axis words in its plane",
        "a target that cannot be reached, as an arc whose ends do not fit",
        "an arc radius that fits no circle",
        "an arc without its centre",
        "words that no command of the line uses",
        "G43.1 is not on the axis of the tool length",
        "a tool number that is too large",
    };
    const bool known = number > 0 && number < static_cast<int>(kWords.size()) &&
                       !kWords.at(static_cast<std::size_t>(number)).empty();
    return "error:" + std::to_string(number) + ": " +
           (known ? std::string(kWords.at(static_cast<std::size_t>(number)))
                  : "an error of this firmware's own numbering");
}

std::string grbl_alarm_words(int number) {
    static constexpr std::array<std::string_view, 11> kWords = {
        "",
        "a limit switch was hit: the position is probably lost, home again",
        "the target leaves the machine's travel: nothing moved, the position is kept",
        "reset while moving: the position is probably lost, home again",
        "the probe was not in its expected state before probing",
        "the probe did not touch within its travel",
        "homing failed: it was reset",
        "homing failed: the safety door opened",
        "homing failed: the switch did not open on pulling off",
        "homing failed: no switch was found",
        "homing failed: the second axis of a pair did not find its switch",
    };
    const bool known = number > 0 && number < static_cast<int>(kWords.size());
    return "ALARM:" + std::to_string(number) + ": " +
           (known ? std::string(kWords.at(static_cast<std::size_t>(number)))
                  : "an alarm of this firmware's own numbering");
}

}  // namespace cam::protocol
