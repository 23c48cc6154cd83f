// SPDX-License-Identifier: GPL-3.0-or-later
// What the commands do.
#include "cam/sim/arc.h"
#include "cam/sim/marlin_board.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace cam::sim {

using namespace std::chrono_literals;

namespace {

constexpr double kDegreesPerSecond = 5;
constexpr double kArcToleranceMm = 0.01;
constexpr std::size_t kE = 3;

/// The number behind a letter; false when the letter is absent.
bool parameter(const std::string& text, char letter, double& value) {
    const std::size_t at = text.find(letter, 1);
    if (at == std::string::npos) {
        return false;
    }
    // No exponent: the E of "Y9.5E2" is the next word, as in the firmware.
    value = 0;
    const char* begin = text.data() + at + 1;
    begin += *begin == '+' ? 1 : 0;
    double read = 0;
    const auto [end, error] =
        std::from_chars(begin, text.data() + text.size(), read, std::chars_format::fixed);
    if (error == std::errc{} && std::isfinite(read)) {
        value = read;
    }
    return true;
}

}  // namespace

void MarlinBoard::start(const std::string& text, Time now) {
    const bool beside = current_.number < 0;  // sent beside the job, by whoever watches
    const char letter = text.empty() ? '\0' : text[0];
    char* end = nullptr;
    const int code =
        text.size() > 1 ? static_cast<int>(std::strtol(text.c_str() + 1, &end, 10)) : -1;
    const bool read = end != nullptr && end != text.c_str() + 1;
    const bool housekeeping =
        letter == 'M' && (code == 105 || code == 110 || code == 115 || code == 154 || code == 155 ||
                          code == 114 || (code == 220 && beside) || code == 876);
    const bool known = (letter == 'G' && code >= 0 && code <= 100) ||
                       (letter == 'M' && code >= 0 && code < 1000) ||
                       (letter == 'T' && code >= 0 && code < 16);
    if (read && known && !housekeeping && on_executed) {
        on_executed(text);
    }
    if (read && letter == 'G') {
        general(code, text, now);
    } else if (read && letter == 'M') {
        miscellaneous(code, text, now);
    } else if (!(read && letter == 'T')) {
        out_ += "echo:Unknown command: \"" + text + "\"\n";
    }
    if (working_ && wait_ == Wait::None) {
        finish(now);
    }
}

void MarlinBoard::general(int code, const std::string& text, Time now) {
    double value = 0;
    switch (code) {
        case 0:
        case 1:
        case 2:
        case 3:
            move(code, text);
            break;
        case 4:
            wait_ = Wait::Drain;
            if (parameter(text, 'P', value) || parameter(text, 'S', value)) {
                const double seconds = text.find('P') != std::string::npos ? value / 1000 : value;
                planner_.add(planner_.target(), 0, seconds, now);
            }
            break;
        case 28:
            planner_.add({0, 0, 0, planner_.target()[kE], 0, 0}, 50, 0.5, now);
            wait_ = Wait::Drain;
            break;
        case 90:
        case 91:
            absolute_ = absolute_e_ = code == 90;
            break;
        case 92:
            set_place(text);
            break;
        default:
            if (code > 100 || code < 0) {
                out_ += "echo:Unknown command: \"" + text + "\"\n";
            }
    }
}

/// From now on the machine stands at these coordinates.
void MarlinBoard::set_place(const std::string& text) {
    Point place = planner_.target();
    double value = 0;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        if (parameter(text, "XYZE"[axis], value)) {
            place[axis] = value;
        }
    }
    planner_.place(place);
}

void MarlinBoard::move(int code, const std::string& text) {
    const Point from = planner_.target();
    Point target = from;
    double value = 0;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        if (parameter(text, "XYZE"[axis], value)) {
            const bool absolute = axis == kE ? absolute_e_ : absolute_;
            target[axis] = absolute ? value : target[axis] + value;
        }
    }
    if (parameter(text, 'F', value) && value > 0) {
        feed_mm_per_s_ = value / 60;
    }
    pending_speed_ = feed_mm_per_s_ * feed_percent_ / 100;
    chords_ = {target};
    chord_ = 0;
    wait_ = Wait::Slot;
    if (code < 2) {
        return;
    }
    Arc arc{from, target, 0, 1, from[0], from[1], code == 2};
    bool readable = false;
    if (parameter(text, 'R', value)) {
        readable = centre_of(arc, value);
    } else {
        for (const auto& [letter, centre] :
             {std::pair{'I', &arc.centre_u}, std::pair{'J', &arc.centre_v}}) {
            if (parameter(text, letter, value)) {
                *centre += value;
                readable = true;
            }
        }
    }
    if (readable) {
        chords_ = arc_points(arc, kArcToleranceMm);
    } else {
        chords_.clear();
        out_ += "echo:G2/G3 bad parameters\n";
    }
}

void MarlinBoard::miscellaneous(int code, const std::string& text, Time now) {
    switch (code) {
        case 0:
        case 1:
            wait_ = Wait::User;
            out_ += "echo:busy: paused for user\n";
            break;
        case 82:
        case 83:
            absolute_e_ = code == 82;
            break;
        case 104:
        case 109:
            heat(nozzle_, text, code == 109, now);
            break;
        case 140:
        case 190:
            heat(bed_, text, code == 190, now);
            break;
        case 112:
            halt();
            break;
        case 115:
            identify();
            break;
        case 154: {
            double seconds = 0;
            (void)parameter(text, 'S', seconds);
            place_seconds_ = static_cast<int>(std::clamp(seconds, 0.0, 60.0));
            next_place_ = now + std::chrono::seconds(place_seconds_);
            break;
        }
        case 155: {
            double seconds = 0;
            (void)parameter(text, 'S', seconds);
            report_seconds_ = static_cast<int>(std::clamp(seconds, 0.0, 60.0));
            next_report_ = now + std::chrono::seconds(report_seconds_);
            break;
        }
        case 220: {
            double percent = 0;
            if (parameter(text, 'S', percent)) {
                feed_percent_ = std::clamp(percent, 10.0, 999.0);
            } else {
                out_ += "FR:" + std::to_string(static_cast<int>(feed_percent_)) + "%\n";
            }
            break;
        }
        case 400:
            wait_ = Wait::Drain;
            break;
        case 876: {
            double choice = -1;
            (void)parameter(text, 'S', choice);
            answers_.push_back(static_cast<int>(choice));
            break;
        }
        default:
            break;
    }
}

void MarlinBoard::identify() {
    out_ +=
        "FIRMWARE_NAME:Marlin 2.0.9 (virtual) SOURCE_CODE_URL:example.invalid "
        "PROTOCOL_VERSION:1.0 MACHINE_TYPE:Virtual Marlin EXTRUDER_COUNT:1 "
        "UUID:00000000-0000-0000-0000-000000000000\n";
    out_ += std::string("Cap:AUTOREPORT_TEMP:") + (options_.autoreport ? "1\n" : "0\n") +
            "Cap:AUTOREPORT_POS:1\n";
    out_ += std::string("Cap:EMERGENCY_PARSER:") + (options_.emergency_parser ? "1" : "0") +
            "\nCap:HOST_ACTION_COMMANDS:0\n";
}

void MarlinBoard::heat(Heater& heater, const std::string& text, bool wait, Time /*now*/) {
    double value = 0;
    if (parameter(text, 'S', value) || parameter(text, 'R', value)) {
        heater.target = value;
    }
    if (options_.instant) {
        heater.celsius = heater.target;
    }
    if (wait) {
        wait_ = Wait::Until;
        heating_ = true;
    }
}

void MarlinBoard::warm(Time now) {
    const double seconds = static_cast<double>((now - warmed_).count()) / 1e9 * options_.speed;
    warmed_ = now;
    for (Heater* heater : {&nozzle_, &bed_}) {
        const double goal = std::max(heater->target, 21.0);
        const double step = options_.instant ? 1e9 : kDegreesPerSecond * seconds;
        heater->celsius += std::clamp(goal - heater->celsius, -step, step);
    }
}

std::string MarlinBoard::temperatures() const {
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "T:%.2f /%.2f B:%.2f /%.2f @:0 B@:0", nozzle_.celsius,
                  nozzle_.target, bed_.celsius, bed_.target);
    return text.data();
}

std::string MarlinBoard::place_text(Time now) const {
    const Point at = planner_.position(now);
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "X:%.2f Y:%.2f Z:%.2f E:%.2f Count X:%.0f Y:%.0f Z:%.0f", at[0], at[1], at[2],
                  at[kE], at[0] * 80, at[1] * 80, at[2] * 400);
    return text.data();
}

}  // namespace cam::sim
