// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/grbl_board.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace cam::sim {

using namespace std::chrono_literals;

namespace {

constexpr std::size_t kLongestLine = 80;
constexpr int kGcodeLocked = 9;
constexpr int kUnknownStatement = 3;
constexpr int kNotIdle = 8;
constexpr int kOverflow = 11;

}  // namespace

GrblBoard::GrblBoard(const BoardOptions& options)
    : options_(options), planner_(options_), parser_(options.axes) {}

void GrblBoard::reset(Time now) {
    planner_.drop(now);
    planner_.place({});
    state_ = options_.homing ? State::Alarm : State::Idle;
    soft_reset(now);
}

void GrblBoard::soft_reset(Time now) {
    const bool lost = state_ == State::Run;
    buffer_.clear();
    partial_.clear();
    blocked_ = draining_ = overlong_ = false;
    planner_.drop(now);
    parser_.clear();
    feed_override_ = 1;
    reports_ = 0;
    if (lost) {
        out_ += "ALARM:3\r\n";
        state_ = State::Alarm;
    } else if (state_ != State::Alarm) {
        state_ = State::Idle;
    }
    out_ += "\r\nGrbl 1.1h ['$' for help]\r\n";
    if (state_ == State::Alarm) {
        out_ += "[MSG:'$H'|'$X' to unlock]\r\n";
    }
}

void GrblBoard::hit_limit(Time now) {
    planner_.drop(now);
    state_ = State::Alarm;
    buffer_.clear();
    partial_.clear();
    blocked_ = draining_ = false;
    out_ += "ALARM:1\r\n[MSG:Reset to continue]\r\n";
}

void GrblBoard::receive(std::string_view bytes, Time now) {
    for (const char byte : bytes) {
        const auto code = static_cast<unsigned char>(byte);
        if (byte == '?' || byte == '!' || byte == '~' || byte == '\x18' || code >= 0x80) {
            advance(now);
            realtime(code, now);
            continue;
        }
        if (buffer_.size() + 1 >= options_.receive_bytes) {
            advance(now);
        }
        if (buffer_.size() + 1 >= options_.receive_bytes) {
            ++overflowed_;
            continue;
        }
        buffer_.push_back(byte);
        fullest_ = std::max(fullest_, buffer_.size());
    }
}

void GrblBoard::realtime(unsigned char byte, Time now) {
    switch (byte) {
        case '?':
            report(now);
            break;
        case '!':
            if (state_ == State::Run || state_ == State::Idle) {
                planner_.hold(now);
                state_ = State::Hold;
            }
            break;
        case '~':
            if (state_ == State::Hold) {
                planner_.release(now);
                state_ = planner_.empty() ? State::Idle : State::Run;
            }
            break;
        case 0x18:
            soft_reset(now);
            break;
        case 0x90:
            feed_override_ = 1;
            break;
        case 0x91:
            feed_override_ = std::min(2.0, feed_override_ + 0.1);
            break;
        case 0x92:
            feed_override_ = std::max(0.1, feed_override_ - 0.1);
            break;
        default:
            break;
    }
}

void GrblBoard::update(Time now) {
    planner_.advance(now);
    if (state_ == State::Run && planner_.empty()) {
        state_ = State::Idle;
    } else if (state_ == State::Idle && !planner_.empty()) {
        state_ = State::Run;
    }
}

void GrblBoard::advance(Time now) {
    update(now);
    while (true) {
        if (blocked_) {
            if (planner_.held() || (draining_ ? !planner_.empty() : planner_.full())) {
                return;
            }
            if (waiting_.kind == GrblBlock::Kind::Move && !run_block(now)) {
                return;
            }
            blocked_ = draining_ = false;
            if (waiting_.kind == GrblBlock::Kind::Dwell && waiting_.drain) {
                // Motion before it is done; now the pause itself.
                waiting_.drain = false;
                planner_.add(planner_.target(), 0, waiting_.seconds, now);
                update(now);
                blocked_ = draining_ = true;
                continue;
            }
            if (waiting_.kind == GrblBlock::Kind::Pause) {
                planner_.hold(now);
                state_ = State::Hold;
            }
            out_ += "ok\r\n";
            update(now);
        }
        if (!take_line(now)) {
            return;
        }
    }
}

/// Reads one whole line and acts on it; false when there is none.
bool GrblBoard::take_line(Time now) {
    while (!buffer_.empty()) {
        const char byte = buffer_.front();
        buffer_.pop_front();
        if (byte == '\n' || byte == '\r') {
            std::string line;
            line.swap(partial_);
            const bool overlong = overlong_;
            overlong_ = false;
            if (overlong) {
                out_ += "error:" + std::to_string(kOverflow) + "\r\n";
            } else {
                answer(line, now);
            }
            return true;
        }
        if (partial_.size() + 1 >= kLongestLine) {
            overlong_ = true;
        } else if (static_cast<unsigned char>(byte) > ' ') {
            partial_ += static_cast<char>(std::toupper(static_cast<unsigned char>(byte)));
        }
    }
    return false;
}

void GrblBoard::answer(const std::string& line, Time now) {
    const int error = line.empty() ? 0 : command(line);
    if (blocked_) {
        return;
    }
    out_ += error == 0 ? std::string("ok\r\n") : "error:" + std::to_string(error) + "\r\n";
    if (reset_after_answer_) {
        reset_after_answer_ = false;
        soft_reset(now);
    }
}

/// Answers what only asks; false: it does more than that.
bool GrblBoard::tell(const std::string& line) {
    if (line == "$I") {
        out_ += "[VER:1.1h.20190830:]\r\n[OPT:V," + std::to_string(options_.planner_blocks - 1) +
                "," + std::to_string(options_.receive_bytes) + "]\r\n";
        if (options_.axes > 3) {
            out_ += "[AXS:" + std::to_string(options_.axes) + ":" +
                    std::string("XYZABC").substr(0, static_cast<std::size_t>(options_.axes)) +
                    "]\r\n";
        }
        return true;
    }
    if (line == "$$") {
        out_ += "$10=1\r\n$13=0\r\n$20=0\r\n$22=" + std::string(options_.homing ? "1" : "0") +
                "\r\n$30=24000\r\n$32=0\r\n$110=3000.000\r\n$130=300.000\r\n$131=300.000\r\n"
                "$132=100.000\r\n";
        return true;
    }
    if (line == "$#") {
        for (int system = 0; system < 6; ++system) {
            out_ += "[G" + std::to_string(54 + system) + ":" +
                    values(offsets_.at(static_cast<std::size_t>(system))) + "]\r\n";
        }
        out_ += "[G28:" + values({}) + "]\r\n[G30:" + values({}) + "]\r\n[G92:" + values({}) +
                "]\r\n[TLO:0.000]\r\n";
        return true;
    }
    if (line == "$G") {
        out_ += parser_.text();
        return true;
    }
    return false;
}

int GrblBoard::command(const std::string& line) {
    if (tell(line)) {
        return 0;
    }
    if (line == "$X" || line == "$H") {
        if (line == "$H") {
            planner_.place({});
        }
        state_ = State::Idle;
        return 0;
    }
    if (line == "$C") {
        if (state_ == State::Check) {
            out_ += "[MSG:Disabled]\r\n";
            reset_after_answer_ = true;
            return 0;
        }
        if (state_ != State::Idle) {
            return kNotIdle;
        }
        state_ = State::Check;
        checked_ = planner_.target();
        out_ += "[MSG:Enabled]\r\n";
        return 0;
    }
    if (line[0] == '$') {
        return kUnknownStatement;
    }
    if (state_ == State::Alarm) {
        return kGcodeLocked;
    }
    GrblBlock block;
    const bool checking = state_ == State::Check;
    const int error = parser_.read(line, checking ? checked_ : planner_.target(), offsets_, block);
    if (error != 0) {
        return error;
    }
    if (checking) {
        checked_ = block.kind == GrblBlock::Kind::Move ? block.target : checked_;
        return 0;
    }
    if (on_executed) {
        on_executed(line);
    }
    waiting_ = std::move(block);
    chord_ = 0;
    blocked_ = true;
    draining_ = waiting_.drain;
    return 0;
}

/// Plans a move, an arc chord by chord; false while the planner has no room for the rest of it.
bool GrblBoard::run_block(Time now) {
    const double speed =
        waiting_.mm_per_s > 0 ? waiting_.mm_per_s * feed_override_ : options_.max_mm_per_s;
    if (waiting_.chords.empty()) {
        planner_.add(waiting_.target, speed, 0, now);
        return true;
    }
    for (; chord_ < waiting_.chords.size(); ++chord_) {
        if (planner_.full()) {
            update(now);
            return false;
        }
        planner_.add(waiting_.chords[chord_], speed, 0, now);
    }
    return true;
}

Point GrblBoard::work_offset() const {
    return offsets_.at(static_cast<std::size_t>(parser_.coordinate_system()));
}

std::string GrblBoard::values(const Point& point) const {
    std::string out;
    for (int axis = 0; axis < options_.axes; ++axis) {
        std::array<char, 48> text{};
        std::snprintf(text.data(), text.size(), "%s%.3f", axis == 0 ? "" : ",",
                      point.at(static_cast<std::size_t>(axis)));
        out += text.data();
    }
    return out;
}

void GrblBoard::report(Time now) {
    const char* names[] = {"Idle", "Run", "Hold:0", "Alarm", "Check"};
    out_ += std::string("<") + names[static_cast<int>(state_)] +
            "|MPos:" + values(planner_.position(now)) + "|FS:0,0";
    if (reports_ % 10 == 0) {
        out_ += "|WCO:" + values(work_offset());
    } else if (reports_ % 10 == 1) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "|Ov:%.0f,100,100", feed_override_ * 100);
        out_ += text.data();
    }
    ++reports_;
    out_ += ">\r\n";
}

std::optional<Time> GrblBoard::next() const {
    if (planner_.empty() || planner_.held()) {
        return std::nullopt;
    }
    return planner_.first_end();
}

std::string GrblBoard::take_output() {
    std::string out;
    out.swap(out_);
    return out;
}

}  // namespace cam::sim
