// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/resume.h"

#include "decomp/base/number.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace cam::stream {

using decomp::decimal;
using decomp::fail;

namespace {

constexpr double kLiftMm = 5;          ///< above the print before it is approached
constexpr double kApproachFeed = 300;  ///< mm/min, down to the place, unless the program was slower
constexpr double kTravelFeed = 6000;
constexpr double kMmPerInch = 25.4;

std::string axis_words(const ModalState& state, std::string_view axes) {
    std::string out;
    for (const char letter : axes) {
        const double value = state.position_mm.at(kAxisLetters.find(letter));
        if (!std::isnan(value)) {
            out += letter + decimal(value, 4);
        }
    }
    return out;
}

void add_move(std::vector<std::string>& lines, const std::string& command, const std::string& words,
              const std::string& tail = {}) {
    if (!words.empty()) {
        lines.push_back(command + words + tail);
    }
}

std::vector<std::string> print_preamble(const ModalState& state) {
    std::vector<std::string> lines{"G21", "G90"};
    const double nozzle =
        state.nozzle_celsius.at(static_cast<std::size_t>(std::clamp(state.tool, 0, 3)));
    if (state.bed_celsius > 0) {
        lines.push_back("M140S" + decimal(state.bed_celsius, 1));
    }
    for (std::size_t tool = 0; tool < state.nozzle_celsius.size(); ++tool) {
        if (state.nozzle_celsius.at(tool) > 0 && static_cast<int>(tool) != state.tool) {
            lines.push_back("M104T" + std::to_string(tool) + "S" +
                            decimal(state.nozzle_celsius.at(tool), 1));
        }
    }
    if (state.bed_celsius > 0) {
        lines.push_back("M190S" + decimal(state.bed_celsius, 1));
    }
    if (state.tool > 0) {
        lines.push_back("T" + std::to_string(state.tool));
    }
    if (nozzle > 0) {
        lines.push_back("M109S" + decimal(nozzle, 1));
    }
    if (state.acceleration > 0) {
        lines.push_back("M204S" + decimal(state.acceleration, 1));
    }
    if (state.speed_percent != 100) {
        lines.push_back("M220S" + decimal(state.speed_percent, 1));
    }
    if (state.flow_percent != 100) {
        lines.push_back("M221S" + decimal(state.flow_percent, 1));
    }
    const double z = state.position_mm[2];
    lines.push_back("G1Z" + decimal(z + kLiftMm, 4) + "F" + decimal(kTravelFeed / 10, 1));
    add_move(lines, "G1", axis_words(state, "XY"), "F" + decimal(kTravelFeed, 1));
    lines.push_back("G1Z" + decimal(z, 4) + "F" + decimal(kTravelFeed / 10, 1));
    lines.push_back(state.fan_0_255 > 0 ? "M106S" + decimal(state.fan_0_255, 0) : "M107");
    lines.push_back("G92E" + decimal(state.e_mm, 5));
    if (state.feed_mm_per_min > 0) {
        lines.push_back("G1F" + decimal(state.feed_mm_per_min, 2));
    }
    lines.emplace_back(state.absolute ? "G90" : "G91");
    lines.emplace_back(state.absolute_e ? "M82" : "M83");
    if (state.inches) {
        lines.emplace_back("G20");
    }
    return lines;
}

std::vector<std::string> mill_preamble(const ModalState& state, const WireOptions& options) {
    std::vector<std::string> lines{"G21", "G90", "G94", "G17"};
    lines.push_back("G" + decimal(state.coordinate_system, 1));
    if (state.path_mode != 0) {
        lines.push_back("G" + decimal(state.path_mode, 1));
    }
    if (state.tool > 0) {
        lines.push_back("T" + std::to_string(state.tool));
    }
    const double z = state.position_mm[2];
    const double high = std::max(state.highest_rapid_mm, z);
    lines.push_back("G0Z" + decimal(high, 4));
    if (state.spindle != 5) {
        lines.push_back("M" + std::to_string(state.spindle) + "S" + decimal(state.spindle_rpm, 1));
        lines.push_back("G4P" + decimal(options.spin_up_s, 2));
    } else if (state.spindle_rpm > 0) {
        lines.push_back("S" + decimal(state.spindle_rpm, 1));
    }
    if (state.mist) {
        lines.emplace_back("M7");
    }
    if (state.flood) {
        lines.emplace_back("M8");
    }
    add_move(lines, "G0", axis_words(state, "XYABC"));
    const double feed =
        state.feed_mm_per_min > 0 ? std::min(state.feed_mm_per_min, kApproachFeed) : kApproachFeed;
    lines.push_back("G1Z" + decimal(z, 4) + "F" + decimal(feed, 2));
    if (state.plane != 17) {
        lines.push_back("G" + std::to_string(state.plane));
    }
    if (state.inches) {
        lines.emplace_back("G20");
    }
    if (state.feed_mode != 94) {
        lines.push_back("G" + std::to_string(state.feed_mode));
    } else if (state.feed_mm_per_min > 0) {
        lines.push_back("F" + decimal(state.feed_mm_per_min / (state.inches ? kMmPerInch : 1), 4));
    }
    if (!state.absolute) {
        lines.emplace_back("G91");
    }
    if (state.motion == 0 || state.motion == 1 || state.motion == 80) {
        lines.push_back("G" + std::to_string(state.motion));
    }
    return lines;
}

/// Calls body(number, motion) after every line.
template <class Body>
void each_state(std::string_view program, Flavour flavour, long first_line, ModalState& state,
                const Body& body) {
    long number = 0;
    while (!program.empty() && number + 1 < first_line) {
        const std::size_t end = std::min(program.find('\n'), program.size());
        const std::string text = bare_line(program.substr(0, end));
        ++number;
        Motion motion;
        if (!text.empty() && text.find(' ') == std::string::npos) {
            motion = apply(state, read_words(text), flavour);
        }
        body(number, motion);
        program.remove_prefix(std::min(end + 1, program.size()));
    }
}

constexpr double kSamePlaceMm = 0.01;

/// Coordinates that one of them does not know are not compared, but X, Y and Z must be known.
bool is_at(const AxisValues& point, const AxisValues& place) {
    for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
        const double off = std::abs(point.at(axis) - place.at(axis));
        if (std::isnan(off) ? axis < 3 : off > kSamePlaceMm) {
            return false;
        }
    }
    return true;
}

/// Whether the straight way of a motion passes a place; all axes run in proportion.
bool leads_through(const Motion& motion, const AxisValues& place) {
    double along = 0;
    double square = 0;
    for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
        const double way = motion.to.at(axis) - motion.from.at(axis);
        const double gone = place.at(axis) - motion.from.at(axis);
        if (!std::isnan(way) && !std::isnan(gone)) {
            along += way * gone;
            square += way * way;
        }
    }
    const double fraction = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
    AxisValues nearest{};
    for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
        const double from = motion.from.at(axis);
        nearest.at(axis) = from + fraction * (motion.to.at(axis) - from);
    }
    return is_at(nearest, place);
}

bool place_known(const ModalState& state) {
    return !std::isnan(state.position_mm[0]) && !std::isnan(state.position_mm[1]) &&
           !std::isnan(state.position_mm[2]) && !std::isnan(state.e_mm);
}

}  // namespace

std::vector<std::string> preamble_of(const ModalState& state, const WireOptions& options) {
    return options.flavour == Flavour::Mill ? mill_preamble(state, options) : print_preamble(state);
}

ModalState replay(std::string_view program, Flavour flavour, long first_line) {
    ModalState state;
    each_state(program, flavour, first_line, state, [](long, const Motion&) {});
    return state;
}

std::optional<long> line_through(std::string_view program, Flavour flavour, long first, long last,
                                 const AxisValues& place) {
    std::optional<long> found;
    ModalState state;
    each_state(program, flavour, last + 1, state, [&](long number, const Motion& motion) {
        const bool straight = state.motion < 2;
        if (!found && number >= first && motion.happens && !motion.machine_coordinates &&
            (straight ? leads_through(motion, place)
                      : is_at(motion.from, place) || is_at(motion.to, place))) {
            found = number;
        }
    });
    return found;
}

decomp::Result<ResumePlan> plan_resume(std::string_view program, const WireOptions& options,
                                       long answered_line, std::size_t planned_lines) {
    // The last lines that could be begun with: where the position is known.
    std::vector<long> good;
    ModalState state;
    each_state(program, options.flavour, answered_line + 2, state, [&](long number, const Motion&) {
        if (place_known(state) && !state.ended) {
            good.push_back(number + 1);
        }
    });
    const long latest = answered_line + 1 - static_cast<long>(planned_lines);
    while (!good.empty() && good.back() > std::max(latest, 1L)) {
        good.pop_back();
    }
    if (good.empty()) {
        return fail("stream.position_unknown",
                    "before line " + std::to_string(answered_line) +
                        " the program has not said where the machine is in X, Y and Z",
                    {}, "the job has hardly begun: begin it anew with --force");
    }
    ResumePlan plan;
    plan.first_line = good.back();
    plan.state = replay(program, options.flavour, plan.first_line);
    plan.preamble = preamble_of(plan.state, options);
    plan.text = "answered for up to line " + std::to_string(answered_line) + "; the last " +
                std::to_string(planned_lines) +
                " of them may not have been carried out. The job goes on with line " +
                std::to_string(plan.first_line) + ", after:\n";
    for (const std::string& line : plan.preamble) {
        plan.text += "  " + line + "\n";
    }
    return plan;
}

}  // namespace cam::stream
