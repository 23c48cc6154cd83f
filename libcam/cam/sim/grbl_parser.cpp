// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/grbl_parser.h"

#include <charconv>
#include <cmath>
#include <set>
#include <vector>

namespace cam::sim {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::string_view kAxisLetters = "XYZABC";

enum Error {
    kFine = 0,
    kExpectedLetter = 1,
    kBadNumber = 2,
    kUnsupported = 20,
    kModalGroup = 21,
    kNoFeed = 22,
    kNotWhole = 23,
    kTwoAxisCommands = 24,
    kRepeated = 25,
    kNoAxisWords = 26,
    kMissingValue = 28,
    kBadTarget = 33,
    kBadRadius = 34,
    kNoOffsets = 35,
    kUnused = 36
};

}  // namespace

struct GrblParser::Words {
    std::vector<double> g;
    std::vector<double> m;
    std::array<double, 26> value{};
    std::array<bool, 26> given{};

    [[nodiscard]] bool has(char letter) const {
        return given.at(static_cast<std::size_t>(letter - 'A'));
    }

    [[nodiscard]] double get(char letter) const {
        return value.at(static_cast<std::size_t>(letter - 'A'));
    }
};

void GrblParser::clear() { modal_ = {}; }

int GrblParser::read(std::string_view line, const Point& from, const std::array<Point, 6>& offsets,
                     GrblBlock& block) {
    block = {};
    Words words;
    while (!line.empty()) {
        const char letter = line.front();
        line.remove_prefix(1);
        if (letter < 'A' || letter > 'Z') {
            return kExpectedLetter;
        }
        line.remove_prefix(line.starts_with('+') ? 1 : 0);
        double exact = 0;
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), exact,
                                                  std::chars_format::fixed);
        if (error != std::errc{} || !std::isfinite(exact)) {
            return kBadNumber;
        }
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
        if (letter == 'G') {
            words.g.push_back(exact);
        } else if (letter == 'M') {
            words.m.push_back(exact);
        } else {
            const auto slot = static_cast<std::size_t>(letter - 'A');
            if (words.given.at(slot)) {
                return kRepeated;
            }
            words.given.at(slot) = true;
            words.value.at(slot) = exact;
        }
    }
    for (const char letter : std::string_view("DEHOUVW")) {
        if (words.has(letter)) {
            return kUnsupported;
        }
    }
    Modal modal = modal_;
    std::set<int> groups;
    bool dwell = false;
    bool machine_coordinates = false;
    bool motion_given = false;
    bool offset_command = false;
    for (const double g : words.g) {
        const int code = static_cast<int>(std::lround(g * 10));
        int group = 0;
        switch (code) {
            case 0:
            case 10:
            case 20:
            case 30:
            case 800:
                group = 1;
                modal.motion = code / 10;
                motion_given = code != 800;
                break;
            case 40:
                dwell = true;
                break;
            case 170:
            case 180:
            case 190:
                group = 2;
                modal.plane = code / 10;
                break;
            case 200:
            case 210:
                group = 6;
                modal.units = code / 10;
                break;
            case 530:
                machine_coordinates = true;
                break;
            case 540:
            case 550:
            case 560:
            case 570:
            case 580:
            case 590:
                group = 12;
                modal.coordinates = code / 10 - 54;
                break;
            case 900:
            case 910:
                group = 3;
                modal.distance = code / 10;
                break;
            case 940:
                group = 5;
                modal.feed_mode = 94;
                break;
            case 920:
                offset_command = true;
                break;
            case 400:
            case 490:
            case 610:
            case 911:
                break;
            default:
                return kUnsupported;
        }
        if (group != 0 && !groups.insert(group).second) {
            return kModalGroup;
        }
    }
    for (const double m : words.m) {
        switch (static_cast<int>(std::lround(m))) {
            case 0:
            case 1:
                block.kind = GrblBlock::Kind::Pause;
                block.drain = true;
                break;
            case 2:
            case 30:
                block.kind = GrblBlock::Kind::End;
                block.drain = true;
                break;
            case 3:
            case 4:
            case 5:
                modal.spindle = static_cast<int>(std::lround(m));
                block.drain = true;
                break;
            case 7:
                modal.mist = true;
                break;
            case 8:
                modal.flood = true;
                break;
            case 9:
                modal.mist = modal.flood = false;
                break;
            default:
                return kUnsupported;
        }
    }
    if (words.has('F')) {
        if (words.get('F') < 0) {
            return 4;
        }
        modal.feed = words.get('F') * (modal.units == 20 ? 25.4 : 1);
    }
    if (words.has('S')) {
        modal.speed = words.get('S');
    }
    if (words.has('T')) {
        modal.tool = static_cast<int>(words.get('T'));
    }
    bool axis_words = false;
    for (std::size_t axis = 0; axis < kAxisLetters.size(); ++axis) {
        if (words.has(kAxisLetters[axis])) {
            if (static_cast<int>(axis) >= axes_) {
                return kUnsupported;
            }
            axis_words = true;
        }
    }
    if (dwell) {
        if (!words.has('P')) {
            return kMissingValue;
        }
        block.kind = GrblBlock::Kind::Dwell;
        block.seconds = words.get('P');
        block.drain = true;
    } else if (axis_words && !offset_command) {
        if (modal.motion == 80) {
            return 31;
        }
        const Point zero{};
        const Point& offset =
            machine_coordinates ? zero : offsets.at(static_cast<std::size_t>(modal.coordinates));
        Modal with = modal;
        with.distance = machine_coordinates ? 90 : modal.distance;
        if (machine_coordinates && modal.motion > 1) {
            return 30;
        }
        if (const int error = motion(words, from, offset, with, block); error != kFine) {
            return error;
        }
    } else if (motion_given && modal.motion >= 2) {
        return kNoAxisWords;
    }
    modal_ = modal;
    return kFine;
}

int GrblParser::motion(const Words& words, const Point& from, const Point& offset, Modal& modal,
                       GrblBlock& block) const {
    const double unit = modal.units == 20 ? 25.4 : 1;
    block.kind = GrblBlock::Kind::Move;
    block.target = from;
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(axes_); ++axis) {
        const char letter = kAxisLetters[axis];
        if (!words.has(letter)) {
            continue;
        }
        const double value = words.get(letter) * (axis < 3 ? unit : 1);
        block.target.at(axis) =
            modal.distance == 90 ? value + offset.at(axis) : from.at(axis) + value;
    }
    if (modal.motion == 0) {
        return kFine;
    }
    if (modal.feed <= 0) {
        return kNoFeed;
    }
    block.mm_per_s = modal.feed / 60;
    if (modal.motion == 1) {
        return kFine;
    }
    const std::size_t u = modal.plane == 17 ? 0 : modal.plane == 18 ? 2 : 1;
    const std::size_t v = modal.plane == 17 ? 1 : modal.plane == 18 ? 0 : 2;
    const double chord = std::hypot(block.target[u] - from[u], block.target[v] - from[v]);
    double radius = 0;
    if (words.has('R')) {
        radius = std::abs(words.get('R') * unit);
        if (chord == 0 || chord > 2 * radius + 0.01) {
            return kBadRadius;
        }
    } else {
        constexpr std::string_view kCentre = "IJK";
        if (!words.has(kCentre[u]) && !words.has(kCentre[v])) {
            return kNoOffsets;
        }
        const double i = words.has(kCentre[u]) ? words.get(kCentre[u]) * unit : 0;
        const double j = words.has(kCentre[v]) ? words.get(kCentre[v]) * unit : 0;
        radius = std::hypot(i, j);
        const double end = std::hypot(block.target[u] - from[u] - i, block.target[v] - from[v] - j);
        if (std::abs(end - radius) > 0.005 && std::abs(end - radius) > 0.001 * radius + 0.5) {
            return kBadTarget;
        }
    }
    const double half = std::asin(std::min(1.0, chord / (2 * std::max(radius, 0.0001))));
    block.length_factor = chord > 0 ? std::max(1.0, half / (chord / (2 * radius))) : 2 * kPi;
    return kFine;
}

std::string GrblParser::text() const {
    std::string out = "[GC:G" + std::to_string(modal_.motion) + " G" +
                      std::to_string(54 + modal_.coordinates) + " G" +
                      std::to_string(modal_.plane) + " G" + std::to_string(modal_.units) + " G" +
                      std::to_string(modal_.distance) + " G94 M" + std::to_string(modal_.spindle);
    out += modal_.flood ? " M8" : modal_.mist ? " M7" : " M9";
    out += " T" + std::to_string(modal_.tool) + " F" +
           std::to_string(static_cast<int>(modal_.feed)) + " S" +
           std::to_string(static_cast<int>(modal_.speed)) + "]\n";
    return out;
}

}  // namespace cam::sim
