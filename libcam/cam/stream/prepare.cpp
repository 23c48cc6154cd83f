// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/prepare.h"

#include "decomp/base/number.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cam::stream {

using decomp::fail;
using protocol::LineKind;

namespace {

constexpr std::string_view kMotionDone[] = {"M400", "G4P0.01"};
constexpr double kSecondsPerMinute = 60;

class Preparer {
  public:
    Preparer(const WireOptions& options, const ModalState& state, bool resumed)
        : options_(options),
          state_(state),
          mill_(options.flavour == Flavour::Mill),
          says_motion_(resumed && mill_) {}

    void add(std::string_view text, long source, LineKind kind = LineKind::Send) {
        job_.lines.add(text, source, kind);
        if (job_.lines.size() % WireJob::kTimeStep == 0) {
            job_.seconds.push_back(static_cast<float>(seconds_));
        }
    }

    decomp::Status line(std::string_view raw, long number) {
        const std::string text = bare_line(raw);
        if (text.empty() || ended_) {
            return {};
        }
        const std::string where = "line " + std::to_string(number);
        if (text.size() > options_.longest_line) {
            return fail("stream.line_too_long",
                        "the line has " + std::to_string(text.size()) +
                            " characters, the machine "
                            "takes " +
                            std::to_string(options_.longest_line),
                        where);
        }
        const bool says_text = text.find(' ') != std::string::npos;
        const Words words = says_text ? Words{} : read_words(text);
        if (!words.readable || (words.count == 0 && !says_text) || text[0] == '/') {
            return fail("stream.unreadable_line", "this is no G-code: '" + text + "'", where);
        }
        if (decomp::Status allowed = check(text, words, where); !allowed) {
            return allowed;
        }
        take(text, words, number, raw);
        return {};
    }

    decomp::Result<WireJob> finish() {
        if (job_.lines.size() == 0) {
            return fail("stream.empty", "the program holds nothing to send");
        }
        if (!ended_) {
            drain(0);
        }
        if (!mill_) {
            add("M114", 0, LineKind::Drain);
            job_.lines.expect(expected());
        }
        job_.total_seconds = seconds_;
        job_.end = state_;
        return std::move(job_);
    }

  private:
    [[nodiscard]] decomp::Status check(const std::string& text, const Words& words,
                                       const std::string& where) const {
        const auto forbidden = [&](const char* why) {
            return fail("stream.forbidden_command", "'" + text + "' " + why, where,
                        "take it out of the program");
        };
        for (const double code : {28.0, 29.0, 110.0, 112.0, 999.0}) {
            if (!mill_ && words.has('M', code)) {
                return forbidden("would disturb the conversation with the printer");
            }
        }
        if (mill_ && text[0] == '$') {
            return forbidden("changes the controller, not the part");
        }
        if (mill_ && words.has('M', 6) && !state_.absolute) {
            return fail("stream.relative_tool_change",
                        "a change of tool while positions are relative (G91)", where,
                        "write G90 before M6: where the job goes on would not be known");
        }
        return {};
    }

    void take(const std::string& text, const Words& words, long number, std::string_view raw) {
        const bool stops = words.has('M', 0) || words.has('M', 1);
        if (mill_ && words.has('M', 6)) {
            change_tool(words, number, raw);
            return;
        }
        const ModalState before = state_;
        const Motion motion = apply(state_, words, options_.flavour);
        count_time(motion, words);
        if (stops) {
            const std::string said = comment_of(raw);
            add(kMotionDone[mill_ ? 1 : 0], number, LineKind::Ask);
            job_.lines.ask("the program pauses in line " + std::to_string(number) +
                           (said.empty() ? "" : " (" + said + ")") + ". Continue?");
            job_.lines.expect(expected());
            return;
        }
        if (mill_ && state_.ended) {
            drain(0);
            add(text, number, LineKind::Drain);
            ended_ = true;
            return;
        }
        add(with_motion(text, words, motion), number,
            writes_memory(words, before) ? LineKind::Alone : LineKind::Send);
    }

    /// The first move of a resumed job says how it moves, for nothing has before it.
    std::string with_motion(const std::string& text, const Words& words, const Motion& motion) {
        if (!says_motion_ || !motion.happens) {
            return text;
        }
        says_motion_ = false;
        for (const double code : {0.0, 1.0, 2.0, 3.0}) {
            if (words.has('G', code)) {
                return text;
            }
        }
        return "G" + std::to_string(state_.motion) + text;
    }

    /// Grbl masks its receiver while it writes its memory, and reads offsets from there.
    [[nodiscard]] bool writes_memory(const Words& words, const ModalState& before) const {
        return mill_ && (words.has('G', 10) || words.has('G', 28.1) || words.has('G', 30.1) ||
                         words.has('G', 28) || words.has('G', 30) ||
                         state_.coordinate_system != before.coordinate_system);
    }

    void change_tool(const Words& words, long number, std::string_view raw) {
        apply(state_, words, options_.flavour);
        const std::string said = comment_of(raw);
        drain(number);
        if (state_.spindle != 5) {
            add("M5", number);
        }
        if (state_.mist || state_.flood) {
            add("M9", number);
        }
        if (options_.parks) {
            add("G53G0Z" + decomp::decimal(options_.park_z_mm / unit(), 4), number);
            says_motion_ = true;
        }
        add(kMotionDone[1], number, LineKind::Ask);
        job_.lines.ask("tool " + std::to_string(state_.tool) +
                       (said.empty() ? "" : " (" + said + ")") +
                       ": change it, and set the zero of Z for its length. Continue?");
        // Its length is the operator's: where the tip is in Z, nobody here knows.
        state_.position_mm[2] = std::nan("");
        if (state_.spindle != 5) {
            add("M" + std::to_string(state_.spindle) + "S" + decomp::decimal(state_.spindle_rpm, 1),
                number);
            add("G4P" + decomp::decimal(options_.spin_up_s, 2), number);
        }
        if (state_.mist) {
            add("M7", number);
        }
        if (state_.flood) {
            add("M8", number);
        }
    }

    void drain(long source) {
        add(kMotionDone[mill_ ? 1 : 0], source, LineKind::Drain);
        job_.lines.expect(expected());
    }

    [[nodiscard]] AxisValues expected() const {
        AxisValues position = state_.position_mm;
        if (!mill_) {
            position[kExtruder] = std::nan("");
        }
        return position;
    }

    [[nodiscard]] double unit() const { return state_.inches ? 25.4 : 1; }

    void count_time(const Motion& motion, const Words& words) {
        if (motion.happens) {
            const double feed =
                motion.rapid && mill_ ? options_.rapid_mm_per_min : state_.feed_mm_per_min;
            seconds_ += feed > 0 ? motion.length_mm / feed * kSecondsPerMinute : 0;
        } else if (words.has('G', 4)) {
            const Word* p = words.find('P');
            const Word* s = words.find('S');
            seconds_ += p != nullptr ? p->value / (mill_ ? 1 : 1000) : s != nullptr ? s->value : 0;
        }
    }

    const WireOptions& options_;
    ModalState state_;
    bool mill_;
    bool says_motion_;
    bool ended_ = false;
    double seconds_ = 0;
    WireJob job_;
};

/// Calls body(line, number) for every line; stops at the first error.
template <class Body>
decomp::Status each_line(std::string_view program, const Body& body) {
    long number = 0;
    while (!program.empty()) {
        const std::size_t end = std::min(program.find('\n'), program.size());
        if (decomp::Status done = body(program.substr(0, end), ++number); !done) {
            return done;
        }
        program.remove_prefix(std::min(end + 1, program.size()));
    }
    return {};
}

}  // namespace

double WireJob::seconds_until(std::size_t count) const {
    const std::size_t step = count / kTimeStep;
    if (count >= lines.size() || step > seconds.size()) {
        return total_seconds;
    }
    const double low = step == 0 ? 0.0 : static_cast<double>(seconds[step - 1]);
    const double high = step < seconds.size() ? static_cast<double>(seconds[step]) : total_seconds;
    return low + (high - low) * static_cast<double>(count % kTimeStep) / kTimeStep;
}

decomp::Result<WireJob> prepare(std::string_view program, const WireOptions& options) {
    return prepare_rest(program, options, 1, {}, {});
}

decomp::Result<WireJob> prepare_rest(std::string_view program, const WireOptions& options,
                                     long first_line, const ModalState& state,
                                     const std::vector<std::string>& preamble) {
    Preparer preparer(options, state, first_line > 1);
    for (const std::string& text : preamble) {
        preparer.add(text, 0);
    }
    const decomp::Status read = each_line(program, [&](std::string_view line, long number) {
        return number < first_line ? decomp::Status{} : preparer.line(line, number);
    });
    if (!read) {
        return fail(read.error());
    }
    return preparer.finish();
}

}  // namespace cam::stream
