// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/machine.h"

#include "cam/verify/limits.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cam::verify {
namespace {

constexpr double kInchMm = 25.4;
constexpr double kPrinterCheck = 862;  ///< M862.1 .. M862.5: is this the right printer
constexpr double kLargestFigure = 1e8;
constexpr std::size_t kMostSightings = 20000;

/// Codes that neither move the nozzle nor push filament, in Marlin or Sailfish.
bool is_harmless(char letter, int code) {
    static constexpr std::array kG = {4, 10, 11, 17, 29, 80, 130};
    static constexpr std::array kM = {
        0,   1,   17,  18,  20,  21,  22,  23,  24,  25,  26,  27,  31,  70,  72,
        73,  75,  76,  77,  84,  85,  92,  105, 106, 107, 108, 110, 111, 114, 115,
        117, 118, 119, 126, 127, 130, 135, 136, 137, 150, 155, 201, 202, 203, 204,
        205, 207, 208, 209, 211, 280, 300, 301, 304, 320, 321, 322, 355, 400, 413,
        420, 486, 500, 501, 502, 503, 569, 572, 593, 862, 900, 907, 914};
    if (letter == 'G') {
        return std::find(kG.begin(), kG.end(), code) != kG.end();
    }
    return letter == 'M' && std::find(kM.begin(), kM.end(), code) != kM.end();
}

bool contains_word(std::string_view text, std::string_view lower_word) {
    const auto same = [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b;
    };
    return std::search(text.begin(), text.end(), lower_word.begin(), lower_word.end(), same) !=
           text.end();
}

}  // namespace

std::string figure(double value, int decimals) {
    return std::abs(value) < kLargestFigure ? decomp::decimal(value, decimals)
                                            : (value < 0 ? "-1e8 or less" : "1e8 or more");
}

std::string quoted(std::string_view line) {
    std::string out(1, '"');
    for (const char c : line.substr(0, 60)) {
        out += c >= ' ' && c < 0x7F && c != '"' ? c : '?';
    }
    return out + '"';
}

Machine::Machine(const profile::FdmSetup& setup, const Options& options)
    : setup_(setup),
      options_(options),
      heights_(setup.machine.chamber.min_mm.head<2>(), setup.machine.chamber.max_mm.head<2>()),
      filament_area_(std::numbers::pi / 4 * std::pow(setup.machine.nozzle.filament_diameter_mm, 2)),
      intended_(options.strangers_program ? 1
                                          : 1 / std::max(0.1, setup.material.extrusion_multiplier)),
      flow_limit_(
          std::min(setup.machine.nozzle.max_flow_mm3_per_s, setup.material.max_flow_mm3_per_s)),
      sailfish_(contains_word(setup.dialect.name, "sailfish") ||
                contains_word(setup.dialect.name, "makerbot")) {}

void Machine::sight(const char* code, std::string text, bool at_layer) {
    if (out_.sightings.size() >= kMostSightings) {
        return;  // a file of nothing but faults; the figures still count
    }
    const Axis& z = axes_[2];
    out_.sightings.push_back(
        {code, line_, at_layer && z.known && z.trusted ? z.position : -1, std::move(text)});
}

void Machine::unknown(const std::string& name) {
    auto& [first, uses] = unknown_[name];
    if (uses++ == 0) {
        first = line_;
        if (!options_.strangers_program) {
            sight("proof.unknown_command",
                  "the command " + name + " is none that this checker knows", false);
        }
    }
}

void Machine::comment(std::string_view text) {
    while (!text.empty() && text.front() == ' ') {
        text.remove_prefix(1);
    }
    if (!text.starts_with("TYPE:") && !text.starts_with("FEATURE:")) {
        return;
    }
    text.remove_prefix(text.find(':') + 1);
    declared_ = true;
    outer_wall_ = contains_word(text, "outer") || contains_word(text, "external perimeter") ||
                  contains_word(text, "overhang");
    if (contains_word(text, "support")) {
        role_ = Role::Support;
    } else if (contains_word(text, "skirt") || contains_word(text, "brim") ||
               contains_word(text, "prime") || contains_word(text, "wipe tower")) {
        role_ = Role::Adhesion;
    } else if (contains_word(text, "custom")) {
        role_ = out_.beads.empty() ? Role::Adhesion : Role::Part;
    } else {
        role_ = Role::Part;
    }
}

void Machine::execute(const GcodeLine& line, long number_of_line) {
    line_ = number_of_line;
    text_ = line.text;
    if (!line.comment.empty()) {
        comment(line.comment);
    }
    switch (line.kind) {
        case GcodeLine::Kind::Empty:
        case GcodeLine::Kind::Unreadable:
            return;
        case GcodeLine::Kind::Malformed:
            sight("proof.bad_number", quoted(line.text) + " holds a number that cannot be read");
            return;
        case GcodeLine::Kind::Foreign:
            unknown(quoted(line.text.substr(0, line.text.find(' '))));
            return;
        case GcodeLine::Kind::Command:
            break;
    }
    command(line, line.words[0]);
    for (std::size_t i = 1; i < line.count; ++i) {
        const Word& word = line.words[i];
        if ((word.letter == 'G' || word.letter == 'M') && word.has_value) {
            command(line, word);
        }
    }
}

void Machine::command(const GcodeLine& line, const Word& word) {
    const double code = word.value;
    const std::string name = std::string(1, word.letter) + figure(code, 3);
    if (!options_.strangers_program &&
        std::find(setup_.dialect.forbidden.begin(), setup_.dialect.forbidden.end(), name) !=
            setup_.dialect.forbidden.end()) {
        sight("proof.forbidden_word",
              "the dialect " + setup_.dialect.name + " must never be told " + name, false);
    }
    if (word.letter == 'M' && std::floor(code) == kPrinterCheck) {
        return;
    }
    if (code < 0 || code != std::floor(code)) {
        unknown(name);
        return;
    }
    switch (word.letter) {
        case 'G':
            g_code(line, static_cast<int>(code));
            break;
        case 'M':
            m_code(line, static_cast<int>(code));
            break;
        default:
            if (code < kTools) {
                tool_ = static_cast<std::size_t>(code);
            } else {
                unknown(name);
            }
    }
}

void Machine::g_code(const GcodeLine& line, int code) {
    switch (code) {
        case 0:
        case 1:
            return linear(line);
        case 2:
        case 3:
            return arc(line, code == 2);
        case 20:
        case 21:
            unit_mm_ = code == 20 ? kInchMm : 1;
            return;
        case 28:
            return home(line, true);
        case 161:
        case 162:
            return home(line, false);
        case 90:
        case 91:
            absolute_ = code == 90;
            if (!sailfish_) {
                e_absolute_ = absolute_;
            }
            return;
        case 92:
            return set_position(line);
        default:
            if (!is_harmless('G', code)) {
                unknown(std::string(1, 'G') + std::to_string(code));
            }
    }
}

void Machine::m_code(const GcodeLine& line, int code) {
    switch (code) {
        case 82:
        case 83:
            e_absolute_ = code == 82;
            return;
        case 132:
            for (std::size_t a = 0; a < 3; ++a) {
                if (line.find("XYZ"[a]) != nullptr || line.count == 1) {
                    axes_[a] = Axis{};
                }
            }
            return;
        case 104:
            return heat(line, false);
        case 109:
            return heat(line, true);
        case 6:
        case 133:
        case 116:
            for (Tool& tool : tools_) {
                tool.heated = true;
            }
            return;
        case 134:
            return;
        case 220:
            feed_scale_ = std::clamp(line.value('S', 100) / 100, 0.01, 10.0);
            return;
        case 221:
            flow_scale_ = std::clamp(line.value('S', 100) / 100, 0.01, 10.0);
            return;
        case 140:
        case 190:
            bed_target_ = line.value('S', line.value('R', bed_target_));
            bed_ever_ = bed_ever_ || bed_target_ > 0;
            return;
        default:
            if (!is_harmless('M', code)) {
                unknown(std::string(1, 'M') + std::to_string(code));
            }
    }
}

void Machine::heat(const GcodeLine& line, bool wait) {
    const double celsius = line.value('S', line.value('R', -1));
    const double least = setup_.material.nozzle_celsius - limits::kNozzleSlackCelsius;
    const double which = line.value('T', static_cast<double>(tool_));
    if (which < 0 || which >= kTools) {
        return;
    }
    Tool& tool = tools_[static_cast<std::size_t>(which)];
    if (wait && sailfish_ && celsius >= 0 && celsius < 150 && celsius < least) {
        bed_target_ = celsius;  // the MakerBot reading of M109: the bed
        bed_ever_ = bed_ever_ || celsius > 0;
        return;
    }
    if (celsius >= 0) {
        tool.heated = celsius <= tool.target ? tool.heated && celsius >= least
                                             : tool.heated && tool.target >= least;
        tool.target = celsius;
    }
    tool.heated = tool.heated || wait;
}

void Machine::home(const GcodeLine& line, bool trusted_after) {
    bool any = false;
    for (const char letter : {'X', 'Y', 'Z'}) {
        any = any || line.find(letter) != nullptr;
    }
    for (std::size_t a = 0; a < 3; ++a) {
        if (!any || line.find("XYZ"[a]) != nullptr) {
            axes_[a] = Axis{0, 0, false, trusted_after};
        }
    }
}

void Machine::set_position(const GcodeLine& line) {
    const bool bare = line.count == 1;
    for (std::size_t a = 0; a < 3; ++a) {
        const Word* word = line.find("XYZ"[a]);
        if (word == nullptr && !bare) {
            continue;
        }
        const double value = word != nullptr ? word->value * unit_mm_ : 0;
        Axis& axis = axes_[a];
        if (axis.known && axis.trusted) {
            axis.offset = axis.position - value;
        } else {
            axis.position = value;
            axis.offset = 0;
            axis.known = true;
        }
    }
    for (const char letter : {'E', 'A', 'B'}) {
        if (const Word* word = line.find(letter); word != nullptr || bare) {
            e_ = word != nullptr ? word->value * unit_mm_ : 0;
            break;
        }
    }
}

Replayed Machine::finish(long lines) {
    end_rush();
    out_.lines = lines;
    // A prime line comes before the first feature comment; without any such comment nothing is
    // declared.
    if (!declared_) {
        for (Bead& bead : out_.beads) {
            bead.role = Role::Part;
        }
    }
    if (options_.strangers_program) {
        for (const auto& [name, use] : unknown_) {
            out_.notes.push_back("unknown command " + name + ", first in line " +
                                 std::to_string(use.first) + ", " + std::to_string(use.second) +
                                 " times");
        }
    }
    if (out_.prime_mm3 > limits::kPrimeMm3) {
        out_.notes.push_back(figure(out_.prime_mm3) +
                             " mm^3 is pushed at a standstill before the first bead");
    }
    for (std::size_t t = 0; t < kTools; ++t) {
        if (tools_[t].target > 0) {
            out_.notes.push_back("the heater of tool " + std::to_string(t) +
                                 " is not switched off at the end");
        }
    }
    if (bed_target_ > 0) {
        out_.notes.emplace_back("the bed is not switched off at the end");
    }
    if (setup_.material.bed_celsius > 0 && !bed_ever_ && !out_.beads.empty()) {
        out_.notes.emplace_back("the bed is never heated");
    }
    return std::move(out_);
}

}  // namespace cam::verify
