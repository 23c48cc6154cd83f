// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/marlin_reply.h"

#include "cam/protocol/scan_detail.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

namespace cam::protocol {

using detail::skip_spaces;
using detail::take_number;
using detail::take_word;

namespace {

bool same_letter(char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
}

bool contains(std::string_view text, std::string_view words) {
    return std::search(text.begin(), text.end(), words.begin(), words.end(), same_letter) !=
           text.end();
}

/// " T:210.0 /210.0 B:60.0 /60.0 T0:… @:127": every heater with a reading.
void read_heaters(std::string_view text, std::vector<Heater>& heaters) {
    while (!text.empty()) {
        const std::size_t colon = text.find(':');
        if (colon == std::string_view::npos) {
            return;
        }
        std::size_t begin = colon;
        while (begin > 0 && std::isalnum(static_cast<unsigned char>(text[begin - 1])) != 0) {
            --begin;
        }
        const std::string_view name = text.substr(begin, colon - begin);
        text.remove_prefix(colon + 1);
        skip_spaces(text);
        const auto celsius = take_number<double>(text);
        const bool is_heater = !name.empty() && name.size() <= 3 &&
                               (name[0] == 'T' || name[0] == 'B' || name[0] == 'C');
        if (!celsius || !is_heater) {
            continue;
        }
        Heater heater{std::string(name), *celsius, 0};
        skip_spaces(text);
        if (take_word(text, "/")) {
            skip_spaces(text);
            heater.target_celsius = take_number<double>(text).value_or(0);
        }
        heaters.push_back(std::move(heater));
    }
}

/// "X:1.00 Y:2.00 Z:3.00 E:4.00 Count X:…"
std::optional<AxisValues> read_position(std::string_view text) {
    text = text.substr(0, text.find("Count"));
    AxisValues values;
    values.fill(std::numeric_limits<double>::quiet_NaN());
    constexpr std::string_view kLetters = "XYZE";
    for (std::size_t axis = 0; axis < kLetters.size(); ++axis) {
        const std::size_t at = text.find(std::string{kLetters[axis], ':'});
        if (at == std::string_view::npos) {
            if (axis < 3) {
                return std::nullopt;
            }
            continue;
        }
        std::string_view rest = text.substr(at + 2);
        skip_spaces(rest);
        if (const auto value = take_number<double>(rest)) {
            values.at(axis) = *value;
        }
    }
    return values;
}

/// "ok", "ok N123 P15 B3", "ok T:…", "ok 123"
bool read_ok(std::string_view line, MarlinReply& reply) {
    if (!take_word(line, "ok") || (!line.empty() && line.front() != ' ')) {
        return false;
    }
    reply.kind = MarlinReply::Kind::Ok;
    if (line.empty()) {
        return true;
    }
    std::string_view rest = line;
    while (!rest.empty()) {
        skip_spaces(rest);
        std::string_view word = rest.substr(0, rest.find(' '));
        rest.remove_prefix(word.size());
        if (word.empty() || word.find(':') != std::string_view::npos) {
            break;
        }
        const char letter = word.front();
        if (!detail::is_digit(letter)) {
            word.remove_prefix(1);
        }
        const auto value = take_number<long>(word);
        if (!value || !word.empty()) {
            break;
        }
        if (letter == 'N' || detail::is_digit(letter)) {
            reply.number = *value;
        } else if (letter == 'P') {
            reply.planner_free = static_cast<int>(std::clamp(*value, -1L, 1000L));
        } else if (letter == 'B') {
            reply.commands_free = static_cast<int>(std::clamp(*value, -1L, 1000L));
        }
    }
    read_heaters(line, reply.heaters);
    return true;
}

/// "Resend: 12", "Resend:12", "rs N12 …", "rs 12"
bool read_resend(std::string_view line, MarlinReply& reply) {
    if (!take_word(line, "Resend:") && !take_word(line, "rs ")) {
        return false;
    }
    reply.kind = MarlinReply::Kind::Resend;
    skip_spaces(line);
    if (line.starts_with('N')) {
        line.remove_prefix(1);
    }
    reply.number = take_number<long>(line);
    if (!line.empty() && line.front() != ' ') {
        reply.number.reset();
    }
    return true;
}

bool read_error(std::string_view line, MarlinReply& reply) {
    if (!take_word(line, "Error:") && !line.starts_with("!!")) {
        return false;
    }
    skip_spaces(line);
    reply.text = line;
    reply.kind = MarlinReply::Kind::Fault;
    for (const char* words : {"checksum", "line number"}) {
        if (contains(line, words)) {
            reply.kind = MarlinReply::Kind::LineFault;
        }
    }
    for (const char* words : {"halted", "kill()", "runaway", "heating failed", "maxtemp", "mintemp",
                              "probing failed", "homing failed", "!!"}) {
        if (contains(line, words)) {
            reply.kind = MarlinReply::Kind::Fatal;
        }
    }
    constexpr std::string_view kLast = "Last Line:";
    if (const std::size_t at = line.find(kLast); at != std::string_view::npos) {
        std::string_view rest = line.substr(at + kLast.size());
        skip_spaces(rest);
        reply.number = take_number<long>(rest);
        if (!rest.empty()) {
            reply.number.reset();
        }
    }
    return true;
}

}  // namespace

MarlinReply read_marlin_reply(std::string_view line) {
    MarlinReply reply;
    skip_spaces(line);
    while (!line.empty() && line.back() == ' ') {
        line.remove_suffix(1);
    }
    reply.text = line;
    if (read_ok(line, reply) || read_resend(line, reply) || read_error(line, reply)) {
        return reply;
    }
    using Kind = MarlinReply::Kind;
    std::string_view rest = line;
    if (line == "start" || line.starts_with("Start")) {
        reply.kind = Kind::Banner;
    } else if (line == "wait") {
        reply.kind = Kind::Wait;
    } else if (take_word(rest, "//action:") || take_word(rest, "// action:")) {
        reply.kind = Kind::Action;
        reply.text = rest;
    } else if (take_word(rest, "Cap:")) {
        reply.kind = Kind::Capability;
        reply.text = rest;
    } else if (line.starts_with("FIRMWARE_NAME:")) {
        reply.kind = Kind::Firmware;
    } else if (take_word(rest, "echo:busy:") || take_word(rest, "busy:")) {
        reply.kind = contains(rest, "paused") ? Kind::WaitsForUser : Kind::Busy;
    } else if (line.starts_with("T:") || line.starts_with("T0:") || line.starts_with("B:")) {
        reply.kind = Kind::Report;
        read_heaters(line, reply.heaters);
    } else if (take_word(rest, "FR:")) {
        reply.feed_percent = take_number<double>(rest);
        reply.kind = reply.feed_percent ? Kind::Report : Kind::Text;
    } else if (line.starts_with("X:")) {
        reply.position_mm = read_position(line);
        reply.kind = reply.position_mm ? Kind::Report : Kind::Text;
    }
    return reply;
}

std::string firmware_field(std::string_view line, std::string_view key) {
    const std::string wanted = std::string(key) + ":";
    const std::size_t at = line.find(wanted);
    if (at == std::string_view::npos) {
        return {};
    }
    std::string_view rest = line.substr(at + wanted.size());
    // The next key is a word in capitals that ends in a colon.
    std::size_t end = rest.size();
    for (std::size_t colon = rest.find(':'); colon != std::string_view::npos;
         colon = rest.find(':', colon + 1)) {
        std::size_t begin = colon;
        while (begin > 0 && (std::isupper(static_cast<unsigned char>(rest[begin - 1])) != 0 ||
                             rest[begin - 1] == '_')) {
            --begin;
        }
        if (begin > 0 && colon - begin >= 3 && rest[begin - 1] == ' ') {
            end = begin - 1;
            break;
        }
    }
    rest = rest.substr(0, end);
    while (!rest.empty() && rest.back() == ' ') {
        rest.remove_suffix(1);
    }
    return std::string(rest);
}

int marlin_checksum(std::string_view text) {
    unsigned sum = 0;
    for (const char c : text) {
        sum ^= static_cast<unsigned char>(c);
    }
    return static_cast<int>(sum);
}

std::string numbered_line(long number, std::string_view text) {
    std::string line = "N" + std::to_string(number) + " ";
    line += text;
    line += "*" + std::to_string(marlin_checksum(line)) + "\n";
    return line;
}

}  // namespace cam::protocol
