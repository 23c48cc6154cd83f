// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/grbl_parser.h"

#include "cam/sim/arc.h"

#include <charconv>
#include <cmath>

namespace cam::sim {

namespace {

constexpr double kMmPerInch = 25.4;
constexpr double kArcToleranceMm = 0.002;  ///< $12
constexpr std::string_view kAxisLetters = "XYZABC";

// What a block is refused for, by Grbl's numbers.
constexpr int kFine = 0;
constexpr int kExpectedLetter = 1;
constexpr int kBadNumber = 2;
constexpr int kNegative = 4;
constexpr int kUnsupported = 20;
constexpr int kModalGroup = 21;
constexpr int kNoFeed = 22;
constexpr int kRepeated = 25;
constexpr int kNoAxisWords = 26;
constexpr int kMissingValue = 28;
constexpr int kG53Motion = 30;
constexpr int kUnusedAxisWords = 31;
constexpr int kBadTarget = 33;
constexpr int kBadRadius = 34;
constexpr int kNoOffsets = 35;

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

int GrblParser::read_words(std::string_view line, Words& words) {
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
    return kFine;
}

int GrblParser::read(std::string_view line, const Point& from, const std::array<Point, 6>& offsets,
                     GrblBlock& block) {
    block = {};
    Words words;
    if (const int error = read_words(line, words); error != kFine) {
        return error;
    }
    Modal modal = modal_;
    Orders orders;
    for (const double g : words.g) {
        if (const int error = take_g(static_cast<int>(std::lround(g * 10)), modal, orders);
            error != kFine) {
            return error;
        }
    }
    for (const double m : words.m) {
        if (const int error = take_m(static_cast<int>(std::lround(m)), modal, block);
            error != kFine) {
            return error;
        }
    }
    if (const int error = act(words, from, offsets, orders, modal, block); error != kFine) {
        return error;
    }
    modal_ = modal;
    return kFine;
}

int GrblParser::take_g(int tenths, Modal& modal, Orders& orders) {
    int group = 0;
    switch (tenths) {
        case 0:
        case 10:
        case 20:
        case 30:
        case 800:
            group = 1;
            modal.motion = tenths / 10;
            orders.motion = tenths != 800;
            break;
        case 40:
            orders.dwell = true;
            break;
        case 170:
        case 180:
        case 190:
            group = 2;
            modal.plane = tenths / 10;
            break;
        case 200:
        case 210:
            group = 6;
            modal.units = tenths / 10;
            break;
        case 530:
            orders.machine_coordinates = true;
            break;
        case 540:
        case 550:
        case 560:
        case 570:
        case 580:
        case 590:
            group = 12;
            modal.coordinates = tenths / 10 - 54;
            break;
        case 900:
        case 910:
            group = 3;
            modal.distance = tenths / 10;
            break;
        case 940:
            group = 5;
            modal.feed_mode = 94;
            break;
        case 920:
            orders.offset = true;
            break;
        case 400:
        case 490:
        case 610:
        case 911:
            break;
        default:
            return kUnsupported;
    }
    return group == 0 || orders.groups.insert(group).second ? kFine : kModalGroup;
}

int GrblParser::take_m(int code, Modal& modal, GrblBlock& block) {
    switch (code) {
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
            modal.spindle = code;
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
    return kFine;
}

int GrblParser::take_values(const Words& words, Modal& modal, bool& axis_words) const {
    if (words.has('F')) {
        if (words.get('F') < 0) {
            return kNegative;
        }
        modal.feed = words.get('F') * (modal.units == 20 ? kMmPerInch : 1);
    }
    if (words.has('S')) {
        modal.speed = words.get('S');
    }
    if (words.has('T')) {
        modal.tool = static_cast<int>(words.get('T'));
    }
    for (std::size_t axis = 0; axis < kAxisLetters.size(); ++axis) {
        if (words.has(kAxisLetters[axis])) {
            if (static_cast<int>(axis) >= axes_) {
                return kUnsupported;
            }
            axis_words = true;
        }
    }
    return kFine;
}

int GrblParser::act(const Words& words, const Point& from, const std::array<Point, 6>& offsets,
                    const Orders& orders, Modal& modal, GrblBlock& block) const {
    bool axis_words = false;
    if (const int error = take_values(words, modal, axis_words); error != kFine) {
        return error;
    }
    if (orders.dwell) {
        if (!words.has('P')) {
            return kMissingValue;
        }
        block.kind = GrblBlock::Kind::Dwell;
        block.seconds = words.get('P');
        block.drain = true;
        return kFine;
    }
    if (!axis_words || orders.offset) {
        return orders.motion && modal.motion >= 2 ? kNoAxisWords : kFine;
    }
    if (modal.motion == 80) {
        return kUnusedAxisWords;
    }
    if (orders.machine_coordinates && modal.motion > 1) {
        return kG53Motion;
    }
    Modal with = modal;
    with.distance = orders.machine_coordinates ? 90 : modal.distance;
    const Point zero{};
    return motion(
        words, from,
        orders.machine_coordinates ? zero : offsets.at(static_cast<std::size_t>(modal.coordinates)),
        with, block);
}

int GrblParser::motion(const Words& words, const Point& from, const Point& offset,
                       const Modal& modal, GrblBlock& block) const {
    const double unit = modal.units == 20 ? kMmPerInch : 1;
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
    return modal.motion == 1 ? kFine : arc(words, from, modal, block);
}

int GrblParser::arc(const Words& words, const Point& from, const Modal& modal, GrblBlock& block) {
    const double unit = modal.units == 20 ? kMmPerInch : 1;
    Arc arc{from, block.target, 0, 1, 0, 0, modal.motion == 2};
    arc.u = modal.plane == 17 ? 0 : modal.plane == 18 ? 2 : 1;
    arc.v = modal.plane == 17 ? 1 : modal.plane == 18 ? 0 : 2;
    if (words.has('R')) {
        if (!centre_of(arc, words.get('R') * unit)) {
            return kBadRadius;
        }
    } else {
        constexpr std::string_view kCentre = "IJK";
        if (!words.has(kCentre[arc.u]) && !words.has(kCentre[arc.v])) {
            return kNoOffsets;
        }
        const double i = words.has(kCentre[arc.u]) ? words.get(kCentre[arc.u]) * unit : 0;
        const double j = words.has(kCentre[arc.v]) ? words.get(kCentre[arc.v]) * unit : 0;
        arc.centre_u = from[arc.u] + i;
        arc.centre_v = from[arc.v] + j;
        const double radius = std::hypot(i, j);
        const double off = std::abs(
            std::hypot(arc.to[arc.u] - arc.centre_u, arc.to[arc.v] - arc.centre_v) - radius);
        // As Grbl: half a millimetre is too much, and so is a thousandth of the radius.
        if (off > 0.005 && (off > 0.5 || off > 0.001 * radius)) {
            return kBadTarget;
        }
    }
    block.chords = arc_points(arc, kArcToleranceMm);
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
