// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/gate.h"

#include "decomp/base/number.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cam::stream {

namespace {

constexpr double kTolerance = 0.05;  ///< mm, of bounds

constexpr std::array kPrintG = {0.0,  1.0,  2.0,  3.0,  4.0,  10.0, 11.0, 17.0, 20.0,
                                21.0, 27.0, 28.0, 29.0, 80.0, 90.0, 91.0, 92.0};
constexpr std::array kPrintM = {
    0.0,   1.0,   17.0,  18.0,  82.0,  83.0,  84.0,  73.0,  75.0,  77.0,  85.0,  92.0,
    104.0, 105.0, 106.0, 107.0, 108.0, 109.0, 113.0, 114.0, 115.0, 117.0, 118.0, 140.0,
    141.0, 149.0, 155.0, 190.0, 191.0, 200.0, 201.0, 203.0, 204.0, 205.0, 207.0, 208.0,
    209.0, 211.0, 218.0, 220.0, 221.0, 300.0, 302.0, 400.0, 401.0, 402.0, 413.0, 420.0,
    425.0, 486.0, 572.0, 593.0, 600.0, 701.0, 702.0, 862.0, 862.1, 862.3, 900.0, 907.0};
constexpr std::array kMillG = {0.0,  1.0,  2.0,  3.0,  4.0,  10.0, 17.0, 18.0, 19.0, 20.0,
                               21.0, 28.0, 28.1, 30.0, 30.1, 38.2, 38.3, 38.4, 38.5, 40.0,
                               43.1, 49.0, 53.0, 54.0, 55.0, 56.0, 57.0, 58.0, 59.0, 61.0,
                               80.0, 90.0, 91.0, 91.1, 92.0, 92.1, 93.0, 94.0};
constexpr std::array kMillM = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 30.0, 56.0};

template <class List>
bool among(const List& list, double value) {
    constexpr double kSame = 0.001;
    return std::any_of(list.begin(), list.end(),
                       [&](double known) { return std::abs(known - value) < kSame; });
}

class Examiner {
  public:
    Examiner(const Limits& limits, const std::map<std::string, AxisValues>& offsets)
        : limits_(limits), offsets_(offsets), mill_(limits.flavour == Flavour::Mill) {}

    void line(std::string_view raw, long number) {
        number_ = number;
        const std::string text = bare_line(raw);
        if (text.empty() || text.find(' ') != std::string::npos) {
            return;
        }
        const Words words = read_words(text);
        if (!words.readable) {
            object("stream.unreadable_line", "this is no G-code: '" + text.substr(0, 60) + "'");
            return;
        }
        codes(words);
        const Motion motion = apply(state_, words, limits_.flavour);
        if (motion.happens) {
            bounds(motion);
        }
        process(words);
    }

    std::vector<Objection> take() { return std::move(found_); }

  private:
    void object(const std::string& code, std::string text) {
        for (Objection& known : found_) {
            if (known.code == code) {
                ++known.times;
                return;
            }
        }
        found_.push_back({code, number_, std::move(text), 1});
    }

    void codes(const Words& words) {
        for (const Word& word : words) {
            if (word.bare || (word.letter != 'G' && word.letter != 'M')) {
                continue;
            }
            const bool known =
                word.letter == 'G'
                    ? (mill_ ? among(kMillG, word.value) : among(kPrintG, word.value))
                    : (mill_ ? among(kMillM, word.value) : among(kPrintM, word.value));
            if (!known) {
                object("stream.unknown_code", std::string(1, word.letter) +
                                                  decomp::decimal(word.value, 1) +
                                                  " is nothing that such a machine must know");
            }
        }
        for (auto axis = static_cast<std::size_t>(limits_.axes); mill_ && axis < kMaxAxes; ++axis) {
            if (words.find(kAxisLetters[axis]) != nullptr) {
                object("stream.missing_axis",
                       "the machine has no axis " + std::string(1, kAxisLetters[axis]));
            }
        }
    }

    [[nodiscard]] AxisValues offset() const {
        AxisValues sum{};
        if (!mill_) {
            return sum;
        }
        std::string name = "G";
        name += decomp::decimal(state_.coordinate_system, 1);
        const auto system = offsets_.find(name);
        const auto shift = offsets_.find("G92");
        for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
            sum.at(axis) = system == offsets_.end() ? std::nan("") : system->second.at(axis);
            sum.at(axis) += shift == offsets_.end() ? 0 : shift->second.at(axis);
        }
        return sum;
    }

    void bounds(const Motion& motion) {
        const AxisValues at = motion.machine_coordinates ? AxisValues{} : offset();
        for (std::size_t axis = 0; axis < static_cast<std::size_t>(limits_.axes); ++axis) {
            const double low = motion.low.at(axis) + at.at(axis);
            const double high = motion.high.at(axis) + at.at(axis);
            // NaN compares as false: what is not known is not compared.
            if (low < limits_.low_mm.at(axis) - kTolerance ||
                high > limits_.high_mm.at(axis) + kTolerance) {
                const double worst = low < limits_.low_mm.at(axis) - kTolerance ? low : high;
                object("stream.bounds", std::string(1, kAxisLetters[axis]) + " goes to " +
                                            decomp::decimal(worst, 2) + ", the machine from " +
                                            decomp::decimal(limits_.low_mm.at(axis), 2) + " to " +
                                            decomp::decimal(limits_.high_mm.at(axis), 2));
            }
        }
    }

    void process(const Words& words) {
        const auto above = [](double value, double limit) { return limit > 0 && value > limit; };
        if (above(state_.feed_mm_per_min, limits_.max_feed_mm_per_min)) {
            object("stream.feed", "F" + decomp::decimal(state_.feed_mm_per_min, 1) +
                                      " is above the machine's " +
                                      decomp::decimal(limits_.max_feed_mm_per_min, 1) + " mm/min");
        }
        if (mill_ && above(state_.spindle_rpm, limits_.max_spindle_rpm)) {
            object("stream.spindle", "S" + decomp::decimal(state_.spindle_rpm, 1) +
                                         " is above the machine's " +
                                         decomp::decimal(limits_.max_spindle_rpm, 1) + " rpm");
        }
        const double nozzle =
            *std::max_element(state_.nozzle_celsius.begin(), state_.nozzle_celsius.end());
        if (!mill_ && (above(nozzle, limits_.max_nozzle_celsius) ||
                       above(state_.bed_celsius, limits_.max_bed_celsius))) {
            object("stream.temperature", "nozzle " + decomp::decimal(nozzle, 0) + ", bed " +
                                             decomp::decimal(state_.bed_celsius, 0) +
                                             " degrees are more than the machine may have");
        }
        (void)words;
    }

    const Limits& limits_;
    const std::map<std::string, AxisValues>& offsets_;
    bool mill_;
    ModalState state_;
    long number_ = 0;
    std::vector<Objection> found_;
};

bool contains(const std::string& text, const std::string& word) {
    return text.find(word) != std::string::npos;
}

}  // namespace

std::vector<Objection> examine_bounds(std::string_view program, const Limits& limits,
                                      const std::map<std::string, AxisValues>& offsets_mm) {
    Examiner examiner(limits, offsets_mm);
    long number = 0;
    while (!program.empty()) {
        const std::size_t end = std::min(program.find('\n'), program.size());
        examiner.line(program.substr(0, end), ++number);
        program.remove_prefix(std::min(end + 1, program.size()));
    }
    return examiner.take();
}

std::vector<Objection> examine_machine(const protocol::Identity& identity,
                                       const WantedMachine& wanted) {
    std::vector<Objection> out;
    const bool other_firmware = !contains(identity.firmware, wanted.firmware);
    if (other_firmware || !contains(identity.machine, wanted.machine)) {
        out.push_back({"stream.identity", 0,
                       "at the port is '" + identity.firmware + "' on '" + identity.machine +
                           "', the profile wants '" + wanted.firmware + "' on '" + wanted.machine +
                           "'",
                       1});
    }
    if (wanted.mill && static_cast<int>(identity.axes.size()) < wanted.axes) {
        out.push_back({"stream.missing_axis", 0,
                       "the machine has the axes " + identity.axes + ", the job needs " +
                           std::to_string(wanted.axes),
                       1});
    }
    if (identity.busy) {
        out.push_back({"stream.machine_busy", 0, "the machine is moving or held", 1});
    }
    if (!identity.homed) {
        out.push_back({"stream.not_homed", 0, "the machine is locked: it wants to be homed", 1});
    }
    return out;
}

const std::vector<std::string>& known_allowances() {
    static const std::vector<std::string> kWords = {
        "bounds", "feed", "identity", "not_homed", "spindle", "temperature", "unknown_code"};
    return kWords;
}

decomp::Status judge(const std::vector<Objection>& objections, const Allowances& allowed) {
    std::vector<const Objection*> left;
    for (const Objection& objection : objections) {
        const std::string word = objection.code.substr(objection.code.find('.') + 1);
        if (std::find(allowed.begin(), allowed.end(), word) == allowed.end()) {
            left.push_back(&objection);
        }
    }
    if (left.empty()) {
        return {};
    }
    const auto where = [](const Objection& objection) {
        return objection.line > 0 ? "line " + std::to_string(objection.line) : std::string();
    };
    const auto text = [](const Objection& objection) {
        return objection.text +
               (objection.times > 1 ? " (" + std::to_string(objection.times) + " lines)" : "");
    };
    const Objection& first = *left.front();
    const std::string word = first.code.substr(first.code.find('.') + 1);
    const std::vector<std::string>& known = known_allowances();
    const bool can_be_allowed = std::find(known.begin(), known.end(), word) != known.end();
    decomp::Error error{first.code,
                        text(first),
                        where(first),
                        can_be_allowed ? "if that is right: --allow " + word : "",
                        {}};
    for (std::size_t i = 1; i < left.size(); ++i) {
        error.notes.push_back(where(*left[i]) + ": " + text(*left[i]) + " [" + left[i]->code + "]");
    }
    return decomp::fail(error);
}

}  // namespace cam::stream
