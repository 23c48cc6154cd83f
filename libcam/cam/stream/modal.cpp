// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/modal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cam::stream {

namespace {

constexpr double kMmPerInch = 25.4;
constexpr double kShortest = 1e-9;  ///< chord that has a direction, mm
constexpr double kFarthest =
    1e8;  ///< where relative moves have summed up to nonsense, mm or degrees

/// Codes with a decimal, such as G59.3, times ten.
int tenths(double value) { return static_cast<int>(std::lround(value * 10)); }

/// The coordinate, or unknown when nothing can stand there.
double known(double value) { return std::abs(value) > kFarthest ? std::nan("") : value; }

double value_of(const Words& words, char letter, double otherwise) {
    const Word* word = words.find(letter);
    return word == nullptr || word->bare ? otherwise : word->value;
}

void apply_g(ModalState& state, int code, Flavour flavour) {
    switch (code) {
        case 0:
        case 10:
        case 20:
        case 30:
        case 800:
            state.motion = code / 10;
            break;
        case 170:
        case 180:
        case 190:
            state.plane = code / 10;
            break;
        case 200:
            state.inches = true;
            break;
        case 210:
            state.inches = false;
            break;
        case 540:
        case 550:
        case 560:
        case 570:
        case 580:
        case 590:
        case 591:
        case 592:
        case 593:
            if (flavour == Flavour::Mill) {
                state.coordinate_system = code / 10.0;
            }
            break;
        case 610:
        case 611:
        case 640:
            if (flavour == Flavour::Mill) {
                state.path_mode = code / 10.0;
            }
            break;
        case 900:
        case 910:
            state.absolute = code == 900;
            if (flavour == Flavour::Print) {
                state.absolute_e = state.absolute;
            }
            break;
        case 930:
        case 940:
        case 950:
            state.feed_mode = code / 10;
            break;
        default:
            break;
    }
}

void apply_mill_m(ModalState& state, int code) {
    switch (code) {
        case 2:
        case 30:
            state.ended = true;
            state.spindle = 5;
            state.mist = state.flood = false;
            break;
        case 3:
        case 4:
        case 5:
            state.spindle = code;
            break;
        case 7:
            state.mist = true;
            break;
        case 8:
            state.flood = true;
            break;
        case 9:
            state.mist = state.flood = false;
            break;
        default:
            break;
    }
}

void apply_print_m(ModalState& state, int code, const Words& words) {
    const double s = value_of(words, 'S', value_of(words, 'R', std::nan("")));
    const auto tool = static_cast<std::size_t>(
        std::clamp(value_of(words, 'T', static_cast<double>(state.tool)), 0.0, 3.0));
    switch (code) {
        case 82:
        case 83:
            state.absolute_e = code == 82;
            break;
        case 104:
        case 109:
            state.nozzle_celsius.at(tool) = std::isnan(s) ? state.nozzle_celsius.at(tool) : s;
            break;
        case 140:
        case 190:
            state.bed_celsius = std::isnan(s) ? state.bed_celsius : s;
            break;
        case 141:
        case 191:
            state.chamber_celsius = std::isnan(s) ? state.chamber_celsius : s;
            break;
        case 106:
            state.fan_0_255 = value_of(words, 'S', 255);
            break;
        case 107:
            state.fan_0_255 = 0;
            break;
        case 204:
            state.acceleration = value_of(words, 'S', value_of(words, 'P', state.acceleration));
            break;
        case 220:
            state.speed_percent = value_of(words, 'S', state.speed_percent);
            break;
        case 221:
            state.flow_percent = value_of(words, 'S', state.flow_percent);
            break;
        default:
            break;
    }
}

/// Lowest and highest coordinates of an arc, and its length.
void trace_arc(const ModalState& state, const Words& words, double unit, bool clockwise,
               Motion& motion) {
    const std::size_t u = state.plane == 17 ? 0 : state.plane == 18 ? 2 : 1;
    const std::size_t v = state.plane == 17 ? 1 : state.plane == 18 ? 0 : 2;
    constexpr std::string_view kCentre = "IJK";
    const double du = motion.to[u] - motion.from[u];
    const double dv = motion.to[v] - motion.from[v];
    double i = value_of(words, kCentre[u], 0) * unit;
    double j = value_of(words, kCentre[v], 0) * unit;
    if (const Word* r = words.find('R'); r != nullptr && !r->bare) {
        const double radius = r->value * unit;
        const double chord = std::hypot(du, dv);
        const double height = std::sqrt(std::max(0.0, radius * radius - chord * chord / 4)) /
                              std::max(chord, kShortest);
        const double side = (clockwise ? -1 : 1) * (radius < 0 ? -1 : 1);
        i = du / 2 - side * dv * height;
        j = dv / 2 + side * du * height;
    }
    const double cu = motion.from[u] + i;
    const double cv = motion.from[v] + j;
    const double radius = std::hypot(i, j);
    double begin = std::atan2(-j, -i);
    double end = std::atan2(motion.to[v] - cv, motion.to[u] - cu);
    constexpr double kTurn = 2 * std::numbers::pi;
    constexpr double kSameAngle = 1e-9;
    if (clockwise) {
        std::swap(begin, end);
    }
    if (end <= begin + kSameAngle) {
        end += kTurn;
    }
    for (int quarter = -8; quarter <= 8; ++quarter) {
        const double angle = quarter * std::numbers::pi / 2;
        if (angle > begin && angle < end) {
            const double pu = cu + radius * std::cos(angle);
            const double pv = cv + radius * std::sin(angle);
            motion.low[u] = std::min(motion.low[u], pu);
            motion.high[u] = std::max(motion.high[u], pu);
            motion.low[v] = std::min(motion.low[v], pv);
            motion.high[v] = std::max(motion.high[v], pv);
        }
    }
    motion.length_mm = std::hypot(motion.length_mm, radius * (end - begin));
}

Motion move(ModalState& state, const Words& words, Flavour flavour) {
    Motion motion;
    motion.happens = true;
    motion.from = motion.to = state.position_mm;
    motion.machine_coordinates = words.has('G', 53);
    motion.rapid = state.motion == 0;
    const double unit = state.inches ? kMmPerInch : 1;
    const std::size_t linear = 3;
    const std::size_t axes = flavour == Flavour::Print ? linear : kMaxAxes;
    double square = 0;
    const bool absolute = state.absolute || motion.machine_coordinates;
    for (std::size_t axis = 0; axis < axes; ++axis) {
        const Word* word = words.find(kAxisLetters[axis]);
        if (word != nullptr && !word->bare) {
            const double value = word->value * (axis < linear ? unit : 1);
            motion.to.at(axis) = known(absolute ? value : motion.from.at(axis) + value);
        }
        const double step = motion.to.at(axis) - motion.from.at(axis);
        square += std::isnan(step) ? 0 : step * step;
        motion.low.at(axis) = std::fmin(motion.from.at(axis), motion.to.at(axis));
        motion.high.at(axis) = std::fmax(motion.from.at(axis), motion.to.at(axis));
    }
    motion.length_mm = std::sqrt(square);
    if (const Word* e = words.find('E'); flavour == Flavour::Print && e != nullptr && !e->bare) {
        state.e_mm = known(state.absolute_e ? e->value * unit : state.e_mm + e->value * unit);
    }
    if (state.motion == 2 || state.motion == 3) {
        trace_arc(state, words, unit, state.motion == 2, motion);
    }
    if (motion.machine_coordinates) {
        // Where that is in work coordinates depends on offsets which only the machine knows.
        for (std::size_t axis = 0; axis < axes; ++axis) {
            if (words.find(kAxisLetters[axis]) != nullptr) {
                state.position_mm.at(axis) = std::nan("");
            }
        }
        return motion;
    }
    state.position_mm = motion.to;
    if (motion.rapid && !std::isnan(motion.to[2])) {
        state.highest_rapid_mm = std::max(state.highest_rapid_mm, motion.to[2]);
    }
    return motion;
}

void set_position(ModalState& state, const Words& words, Flavour flavour) {
    const double unit = state.inches ? kMmPerInch : 1;
    for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
        const Word* word = words.find(kAxisLetters[axis]);
        if (word != nullptr && !word->bare) {
            state.position_mm.at(axis) = known(word->value * (axis < 3 ? unit : 1));
        }
    }
    if (const Word* e = words.find('E'); flavour == Flavour::Print && e != nullptr) {
        state.e_mm = known(e->value * unit);
    }
}

/// Whether a G code, in tenths, reads axis words as something else than a target of motion.
bool takes_axis_words(int code) {
    return code == 40 || code == 100 || code == 920 || code == 280 || code == 300 || code == 281 ||
           code == 301 || code == 290 || code == 800 || code == 921 || code == 431;
}

/// The machine goes to a place that only it knows.
void go_home(ModalState& state, const Words& words, Flavour flavour) {
    const bool all =
        words.find('X') == nullptr && words.find('Y') == nullptr && words.find('Z') == nullptr;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (all || flavour == Flavour::Mill || words.find(kAxisLetters[axis]) != nullptr) {
            state.position_mm.at(axis) = std::nan("");
        }
    }
}

}  // namespace

AxisValues ModalState::unknown() {
    AxisValues values;
    values.fill(std::numeric_limits<double>::quiet_NaN());
    return values;
}

Motion apply(ModalState& state, const Words& words, Flavour flavour) {
    bool moves_elsewhere = false;  // axis words that are no target
    bool sets_position = false;
    for (const Word& word : words) {
        if (word.letter == 'G' && !word.bare) {
            const int code = tenths(word.value);
            apply_g(state, code, flavour);
            sets_position = sets_position || code == 920;
            moves_elsewhere = moves_elsewhere || takes_axis_words(code);
            if (code == 280 || code == 300 || (code == 290 && flavour == Flavour::Print)) {
                go_home(state, words, flavour);
            }
        } else if (word.letter == 'M' && !word.bare) {
            const int code = static_cast<int>(std::lround(word.value));
            if (flavour == Flavour::Mill) {
                apply_mill_m(state, code);
            } else {
                apply_print_m(state, code, words);
            }
        } else if (word.letter == 'T' && !word.bare &&
                   (flavour == Flavour::Mill || words.find('M') == nullptr)) {
            state.tool = static_cast<int>(std::clamp(word.value, 0.0, 99999.0));
        }
    }
    const bool is_command_only = flavour == Flavour::Print && words.find('G') == nullptr;
    if (const Word* f = words.find('F'); f != nullptr && !f->bare && !is_command_only) {
        state.feed_mm_per_min = f->value * (state.inches ? kMmPerInch : 1);
    }
    if (const Word* s = words.find('S'); flavour == Flavour::Mill && s != nullptr && !s->bare) {
        state.spindle_rpm = s->value;
    }
    if (sets_position) {
        set_position(state, words, flavour);
        return {};
    }
    const bool axis_words = std::any_of(words.begin(), words.end(), [&](const Word& word) {
        return kAxisLetters.find(word.letter) != std::string_view::npos ||
               (word.letter == 'E' && flavour == Flavour::Print);
    });
    if (axis_words && !moves_elsewhere && !is_command_only && state.motion >= 0 &&
        state.motion <= 3) {
        return move(state, words, flavour);
    }
    return {};
}

}  // namespace cam::stream
