// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/replay.h"

#include "cam/verify/gcode_reader.h"
#include "cam/verify/limits.h"
#include "cam/verify/printed_heights.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace cam::verify {
namespace {

using decomp::decimal;

constexpr double kInchMm = 25.4;
constexpr double kStandstillMm = 0.002;
constexpr std::size_t kTools = 16;
constexpr std::size_t kMostSightings = 20000;

/// Codes that neither move the nozzle nor push filament, in Marlin or Sailfish.
bool is_harmless(char letter, int code) {
    static constexpr std::array kG = {4, 10, 11, 17, 21, 29, 80, 130};
    static constexpr std::array kM = {
        0,   1,   17,  18,  20,  21,  22,  23,  24,  25,  26,  27,  31,  70,  72,
        73,  75,  76,  77,  84,  85,  92,  105, 106, 107, 108, 110, 111, 114, 115,
        117, 118, 119, 126, 127, 130, 135, 136, 137, 150, 155, 201, 202, 203, 204,
        205, 207, 208, 209, 211, 220, 221, 280, 300, 301, 304, 320, 321, 322, 355,
        400, 413, 420, 486, 500, 501, 502, 503, 569, 572, 593, 862, 900, 907, 914};
    if (letter == 'G') {
        return std::find(kG.begin(), kG.end(), code) != kG.end() && code != 10 && code != 11;
    }
    return letter == 'M' && std::find(kM.begin(), kM.end(), code) != kM.end();
}

std::string number(double value, int decimals = 2) {
    return std::abs(value) < 1e8 ? decimal(value, decimals)
                                 : (value < 0 ? "-1e8 or less" : "1e8 or more");
}

/// The start of a line, fit for a message whatever its bytes.
std::string quoted(std::string_view line) {
    std::string out(1, '"');
    for (const char c : line.substr(0, 60)) {
        out += c >= ' ' && c < 0x7F && c != '"' ? c : '?';
    }
    return out + '"';
}

bool contains_word(std::string_view text, std::string_view lower_word) {
    const auto same = [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b;
    };
    return std::search(text.begin(), text.end(), lower_word.begin(), lower_word.end(), same) !=
           text.end();
}

/// One linear axis. The frame is trusted once the printer knows where it is; the value may be
/// unknown after homing.
struct Axis {
    double position = 0;
    double offset = 0;  ///< of G92: position = programmed + offset
    bool known = false;
    bool trusted = true;
};

struct Tool {
    double fed = 0;
    double high_water = 0;  ///< filament beyond it is deposited; below it is retraction made good
    double target = 0;
    bool heated = false;  ///< waited for since the target was raised
};

/// Consecutive moves above the flow limit on one height.
struct Rush {
    long line = 0;
    double z = 0;
    double flow = 0;
    double length = 0;
};

class Machine {
  public:
    Machine(const profile::FdmSetup& setup, const Options& options)
        : setup_(setup),
          options_(options),
          heights_(setup.machine.chamber.min_mm.head<2>(), setup.machine.chamber.max_mm.head<2>()),
          filament_area_(std::numbers::pi / 4 *
                         std::pow(setup.machine.nozzle.filament_diameter_mm, 2)),
          flow_limit_(
              std::min(setup.machine.nozzle.max_flow_mm3_per_s, setup.material.max_flow_mm3_per_s)),
          sailfish_(contains_word(setup.dialect.name, "sailfish") ||
                    contains_word(setup.dialect.name, "makerbot")) {}

    void execute(const GcodeLine& line, long number);
    Replayed finish(long lines);

  private:
    void comment(std::string_view text);
    void command(const GcodeLine& line, const Word& word);
    void g_code(const GcodeLine& line, int code);
    void m_code(const GcodeLine& line, int code);
    void linear(const GcodeLine& line);
    void arc(const GcodeLine& line, bool clockwise);
    void home(const GcodeLine& line, bool trusted_after);
    void set_position(const GcodeLine& line);
    void heat(const GcodeLine& line, bool wait);
    void unknown(const std::string& name);
    void sight(const char* code, std::string text, bool at_layer = true);
    [[nodiscard]] double end_of(const GcodeLine& line, std::size_t axis, bool& given);
    [[nodiscard]] double filament_of(const GcodeLine& line);
    void go(const std::array<double, 3>& to, const std::array<bool, 3>& given, double filament);
    void check_bounds(const std::array<bool, 3>& given);
    void deposit(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double filament,
                 bool was_known);
    void check_flow(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double volume);
    [[nodiscard]] bool near_chamber(const Eigen::Vector3d& point) const;
    void check_heat();
    void end_rush();

    const profile::FdmSetup& setup_;
    const Options& options_;
    PrintedHeights heights_;
    double filament_area_;
    double flow_limit_;
    bool sailfish_;

    std::array<Axis, 3> axes_;
    std::array<Tool, kTools> tools_;
    std::size_t tool_ = 0;
    double e_ = 0;
    double unit_mm_ = 1;
    double feed_mm_per_s_ = 0;
    bool absolute_ = true;
    bool e_absolute_ = true;
    double bed_target_ = 0;
    Role role_ = Role::Part;
    bool declared_ = false;  ///< a feature comment has been seen
    bool cold_told_ = false;
    bool bed_ever_ = false;
    long line_ = 0;
    std::string_view text_;
    std::optional<Rush> rush_;
    std::map<std::string, std::pair<long, int>> unknown_;  ///< first line and number of uses
    Replayed out_;
};

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
    const std::string name = std::string(1, word.letter) + number(code, 3);
    if (!options_.strangers_program &&
        std::find(setup_.dialect.forbidden.begin(), setup_.dialect.forbidden.end(), name) !=
            setup_.dialect.forbidden.end()) {
        sight("proof.forbidden_word",
              "the dialect " + setup_.dialect.name + " must never be told " + name, false);
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

double Machine::end_of(const GcodeLine& line, std::size_t axis, bool& given) {
    const Word* word = line.find("XYZ"[axis]);
    const Axis& state = axes_[axis];
    given = word != nullptr;
    if (word == nullptr) {
        return state.position;
    }
    if (!word->has_value) {
        sight("proof.bad_number", quoted(text_) + " names an axis without a number");
        given = false;
        return state.position;
    }
    const double value = word->value * unit_mm_;
    return absolute_ ? value + state.offset : state.position + value;
}

double Machine::filament_of(const GcodeLine& line) {
    const Word* word = line.find('E');
    if (word == nullptr) {
        word = sailfish_ ? line.find(tool_ == 1 ? 'B' : 'A') : nullptr;
    }
    if (word == nullptr) {
        return 0;
    }
    if (!word->has_value) {
        sight("proof.bad_number", quoted(text_) + " names an axis without a number");
        return 0;
    }
    const double value = word->value * unit_mm_;
    const double step = e_absolute_ ? value - e_ : value;
    e_ += step;
    return step;
}

void Machine::linear(const GcodeLine& line) {
    if (const Word* feed = line.find('F'); feed != nullptr && feed->has_value && feed->value > 0) {
        feed_mm_per_s_ = feed->value * unit_mm_ / 60;
    }
    std::array<double, 3> to{};
    std::array<bool, 3> given{};
    for (std::size_t a = 0; a < 3; ++a) {
        to[a] = end_of(line, a, given[a]);
    }
    go(to, given, filament_of(line));
}

void Machine::arc(const GcodeLine& line, bool clockwise) {
    if (const Word* feed = line.find('F'); feed != nullptr && feed->has_value && feed->value > 0) {
        feed_mm_per_s_ = feed->value * unit_mm_ / 60;
    }
    std::array<double, 3> to{};
    std::array<bool, 3> given{};
    for (std::size_t a = 0; a < 3; ++a) {
        to[a] = end_of(line, a, given[a]);
    }
    const double filament = filament_of(line);
    const std::array<double, 3> from = {axes_[0].position, axes_[1].position, axes_[2].position};
    Eigen::Vector2d start(from[0], from[1]);
    Eigen::Vector2d end(to[0], to[1]);
    Eigen::Vector2d centre =
        start + Eigen::Vector2d(line.value('I', 0), line.value('J', 0)) * unit_mm_;
    if (const Word* word = line.find('R'); word != nullptr && word->has_value) {
        const Eigen::Vector2d chord = end - start;
        const double radius = word->value * unit_mm_;
        const double half = chord.norm() / 2;
        const double rise = std::sqrt(std::max(0.0, radius * radius - half * half));
        const Eigen::Vector2d side = Eigen::Vector2d(-chord.y(), chord.x()).normalized();
        centre = start + chord / 2 + side * rise * (clockwise == (radius > 0) ? -1 : 1);
    }
    const double radius = (start - centre).norm();
    if (!(radius > 1e-6) || !axes_[0].known || !axes_[1].known ||
        std::abs((end - centre).norm() - radius) > 0.5) {
        sight("proof.bad_arc", quoted(text_) + " is no arc from where the nozzle is");
        go(to, given, filament);
        return;
    }
    const double first = std::atan2(start.y() - centre.y(), start.x() - centre.x());
    double sweep = std::atan2(end.y() - centre.y(), end.x() - centre.x()) - first;
    const double turn = 2 * std::numbers::pi;
    sweep = clockwise ? (sweep >= -1e-9 ? sweep - turn : sweep)
                      : (sweep <= 1e-9 ? sweep + turn : sweep);
    // Chords that leave the arc by 0.02 mm at most.
    const double step = 2 * std::acos(std::max(0.0, 1 - 0.02 / std::max(radius, 0.04)));
    const int steps = static_cast<int>(std::clamp(std::ceil(std::abs(sweep) / step), 1.0, 3600.0));
    for (int k = 1; k <= steps; ++k) {
        const double t = static_cast<double>(k) / steps;
        std::array<double, 3> point = to;
        if (k < steps) {
            point = {centre.x() + radius * std::cos(first + t * sweep),
                     centre.y() + radius * std::sin(first + t * sweep),
                     from[2] + t * (to[2] - from[2])};
        }
        go(point, {true, true, given[2]}, filament / steps);
    }
}

void Machine::go(const std::array<double, 3>& to, const std::array<bool, 3>& given,
                 double filament) {
    const Eigen::Vector3d from(axes_[0].position, axes_[1].position, axes_[2].position);
    bool was_known = true;
    for (const Axis& axis : axes_) {
        was_known = was_known && axis.known;
    }
    for (std::size_t a = 0; a < 3; ++a) {
        Axis& axis = axes_[a];
        if (given[a]) {
            if (a == 2 && (!axis.known || to[a] != axis.position)) {
                out_.climbs.push_back(
                    {static_cast<float>(to[a]), static_cast<std::int32_t>(line_)});
            }
            axis.position = to[a];
            axis.known = axis.known || absolute_;
        }
    }
    const Eigen::Vector3d end(axes_[0].position, axes_[1].position, axes_[2].position);
    if (filament != 0) {
        deposit(from, end, filament, was_known);
    }
    check_bounds(given);
    const bool trusted = axes_[0].trusted && axes_[1].trusted && axes_[2].trusted;
    const bool known = axes_[0].known && axes_[1].known && axes_[2].known;
    if (trusted && known && (given[0] || given[1] || given[2])) {
        const double depth = heights_.depth(was_known ? from : end, end);
        if (depth > limits::kBelowSlackMm &&
            !(was_known && heights_.depth(from, from) > limits::kBelowSlackMm &&
              end.z() > from.z())) {
            ++out_.moves_below_printed;
            sight("proof.below_printed", "the nozzle goes " + number(depth) +
                                             " mm below material that is printed already, " +
                                             number(limits::kBelowSlackMm) + " mm is allowed");
        }
    }
}

void Machine::check_bounds(const std::array<bool, 3>& given) {
    const auto& chamber = setup_.machine.chamber;
    for (std::size_t a = 0; a < 3; ++a) {
        const Axis& axis = axes_[a];
        if (!given[a] || !axis.known || !axis.trusted) {
            continue;
        }
        const auto index = static_cast<Eigen::Index>(a);
        const double low = chamber.min_mm[index];
        const double high = chamber.max_mm[index];
        if (axis.position < low - limits::kChamberSlackMm ||
            axis.position > high + limits::kChamberSlackMm) {
            ++out_.moves_outside_chamber;
            sight("proof.outside_chamber", std::string("a move to ") + "XYZ"[a] +
                                               number(axis.position, 3) + ", the chamber is " +
                                               number(low, 3) + " .. " + number(high, 3) + " mm");
            return;
        }
    }
}

void Machine::deposit(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double filament,
                      bool was_known) {
    Tool& tool = tools_[tool_];
    tool.fed += filament;
    const double pushed = tool.fed - tool.high_water;
    if (pushed <= 1e-9) {
        return;
    }
    tool.high_water = tool.fed;
    const double volume = pushed * filament_area_;
    out_.filament_mm += pushed;
    out_.extruded_mm3 += volume;
    check_heat();
    const double run_mm = (to - from).head<2>().norm();
    if (!was_known && run_mm > kStandstillMm) {
        sight("proof.unknown_position",
              "filament is pushed on a move that starts nobody knows where", false);
        return;
    }
    if (run_mm <= kStandstillMm) {
        if (out_.beads.empty()) {
            out_.prime_mm3 += volume;
            return;
        }
        out_.blob_mm3 += volume;
        if (volume > limits::kBlobMm3) {
            sight("proof.blob", number(volume) + " mm^3 (" + number(pushed) +
                                    " mm of filament) is pushed at a standstill, " +
                                    number(limits::kBlobMm3) + " mm^3 is allowed");
        }
        return;
    }
    for (Axis& axis : axes_) {
        axis.trusted = true;
    }
    check_flow(from, to, volume);
    if (!near_chamber(from) || !near_chamber(to)) {
        return;  // reported by check_bounds
    }
    heights_.raise(from, to);
    out_.beads.push_back({static_cast<float>(from.x()), static_cast<float>(from.y()),
                          static_cast<float>(to.x()), static_cast<float>(to.y()),
                          static_cast<float>(to.z()), static_cast<float>(volume),
                          static_cast<std::int32_t>(line_), declared_ ? role_ : Role::Adhesion});
}

bool Machine::near_chamber(const Eigen::Vector3d& point) const {
    constexpr double kNearMm = 10;
    const auto& chamber = setup_.machine.chamber;
    return ((point - chamber.min_mm).array() >= -kNearMm).all() &&
           ((point - chamber.max_mm).array() <= kNearMm).all();
}

void Machine::check_heat() {
    const Tool& tool = tools_[tool_];
    const double least = setup_.material.nozzle_celsius - limits::kNozzleSlackCelsius;
    if (cold_told_ || (tool.target >= least && tool.heated)) {
        return;
    }
    cold_told_ = true;
    if (tool.target < least) {
        sight("proof.cold_extrusion", "filament is pushed while the nozzle is set to " +
                                          number(tool.target, 1) + " C, " + setup_.material.name +
                                          " needs " + number(least, 1) + " C");
    } else {
        sight("proof.cold_extrusion",
              "filament is pushed before the program has waited for the nozzle to reach " +
                  number(tool.target, 1) + " C");
    }
}

void Machine::check_flow(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double volume) {
    const Eigen::Vector3d step = (to - from).cwiseAbs();
    double seconds = feed_mm_per_s_ > 0 ? step.norm() / feed_mm_per_s_ : 0;
    for (int a = 0; a < 3; ++a) {
        const double fastest = setup_.machine.motion.max_speed_mm_per_s[a];
        seconds = fastest > 0 ? std::max(seconds, step[a] / fastest) : seconds;
    }
    if (seconds <= 0) {
        return;
    }
    const double flow = volume / seconds;
    // Shorter than a tenth of a millimetre the printed decimals of E decide the figure.
    if (step.norm() < 0.1) {
        return;
    }
    out_.max_flow_mm3_per_s = std::max(out_.max_flow_mm3_per_s, flow);
    if (flow <= flow_limit_ * limits::kFlowSlack) {
        return;
    }
    if (rush_ && rush_->z != to.z()) {
        end_rush();
    }
    if (!rush_) {
        rush_ = Rush{line_, to.z(), 0, 0};
    }
    rush_->flow = std::max(rush_->flow, flow);
    rush_->length += step.norm();
}

void Machine::end_rush() {
    if (rush_) {
        out_.sightings.push_back({"proof.flow", rush_->line, rush_->z,
                                  "up to " + number(rush_->flow) + " mm^3/s on " +
                                      number(rush_->length, 1) + " mm of path, the limit is " +
                                      number(flow_limit_) + " mm^3/s"});
        rush_.reset();
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
        out_.notes.push_back(number(out_.prime_mm3) +
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

}  // namespace

decomp::Result<Replayed> replay(std::string_view program, const profile::FdmSetup& setup,
                                const Options& options, const decomp::Run& run) {
    Machine machine(setup, options);
    GcodeReader reader(program);
    GcodeLine line;
    while (reader.next(line)) {
        if (line.kind == GcodeLine::Kind::Unreadable) {
            return decomp::fail("proof.unreadable", "this is no G-code",
                                "line " + std::to_string(reader.number()),
                                "give the program as text, before any conversion");
        }
        if ((reader.number() & 0x3FFF) == 0 && run.cancelled()) {
            return decomp::cancelled();
        }
        machine.execute(line, reader.number());
    }
    return machine.finish(reader.number());
}

}  // namespace cam::verify
