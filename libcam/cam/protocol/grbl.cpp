// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/grbl.h"

#include <algorithm>
#include <cmath>

namespace cam::protocol {

using namespace std::chrono_literals;

namespace {

constexpr Instant kCheckWait = 5s;
constexpr Instant kIdleWait = 2s;  ///< idle with lines outstanding: answers or lines were lost
constexpr double kMmPerInch = 25.4;

}  // namespace

Grbl::Grbl(const JobLines& job, LinkOptions options) : job_(job), options_(options) {
    counts_.total = job.size();
}

bool Grbl::streams() const {
    return phase_ == Phase::Running || (phase_ == Phase::Checking && check_ == Check::Reading);
}

std::size_t Grbl::window() const {
    const std::size_t told = identity_.receive_bytes;
    return told > 1 ? told - 1 : options_.receive_bytes;
}

void Grbl::run(std::size_t first, Instant now) {
    if (phase_ != Phase::Ready) {
        return;
    }
    first_ = first;
    last_status_ = last_ok_ = now;
    if (!options_.precheck) {
        begin_running(now);
        return;
    }
    for (const char* name : {"G92", "TLO"}) {
        const auto offset = identity_.offsets_mm.find(name);
        if (offset != identity_.offsets_mm.end() &&
            std::any_of(offset->second.begin(), offset->second.end(),
                        [](double value) { return value != 0; })) {
            emit(Event::Kind::Warning,
                 std::string(name) +
                     " is set, and leaving the check mode would clear it: the "
                     "job is not checked by the controller");
            begin_running(now);
            return;
        }
    }
    begin_check(now);
}

void Grbl::begin_check(Instant now) {
    phase_ = Phase::Checking;
    check_ = Check::Entering;
    check_until_ = now + kCheckWait;
    out_.bytes += "$C\n";
}

void Grbl::begin_running(Instant now) {
    phase_ = Phase::Running;
    check_ = Check::None;
    acked_ = next_ = first_;
    last_ok_ = now;
    fill(now);
}

void Grbl::fill(Instant now) {
    while (streams() && !settling_ && next_ < job_.size()) {
        const std::size_t length = job_.text(next_).size() + 1;
        const bool checking = phase_ == Phase::Checking;
        if (!checking && next_ >= allowed_) {
            break;
        }
        if (!in_flight_.empty()) {
            const bool barrier = !checking && (job_.kind(next_) != LineKind::Send ||
                                               job_.kind(next_ - 1) != LineKind::Send);
            if (barrier || bytes_in_flight_ + length > window()) {
                break;
            }
        }
        if (length > window()) {
            halt("protocol.line_too_long",
                 entry_words(next_) + " is longer than the controller's buffer", now);
            return;
        }
        out_.bytes += job_.text(next_);
        out_.bytes += '\n';
        in_flight_.push_back(length);
        bytes_in_flight_ += length;
        ++next_;
        last_ok_ = in_flight_.size() == 1 ? now : last_ok_;
    }
    if (acked_ < job_.size() || !in_flight_.empty() || settling_) {
        return;
    }
    if (phase_ == Phase::Checking && check_ == Check::Reading) {
        check_ = Check::Leaving;
        check_until_ = now + kCheckWait;
        out_.bytes += "$C\n";
    } else if (phase_ == Phase::Running) {
        phase_ = Phase::Finished;
        emit(Event::Kind::Finished);
    }
}

void Grbl::receive(std::string_view bytes, Instant now) {
    while (splitter_.next(bytes)) {
        if (phase_ != Phase::Closed && !is_over(phase_)) {
            reply(splitter_.line(), now);
        }
    }
}

void Grbl::reply(std::string_view line, Instant now) {
    using Kind = GrblReply::Kind;
    const GrblReply reply = read_grbl_reply(line);
    if (reply.kind == Kind::Status) {
        on_status(reply, now);
    }
    if (phase_ == Phase::Meeting) {
        meeting_reply(reply, now);
        return;
    }
    switch (reply.kind) {
        case Kind::Ok:
            on_ok(now);
            break;
        case Kind::Error:
            on_error(reply.number, now);
            break;
        case Kind::Alarm:
            if (!halting_) {
                out_.discard = true;
                fail("protocol.alarm", grbl_alarm_words(reply.number));
            }
            break;
        case Kind::Banner:
            on_banner(now);
            break;
        case Kind::Message:
            emit(Event::Kind::Notice, "the machine says: " + std::string(reply.text));
            break;
        case Kind::Garbled:
            ++counts_.strange;
            if (!halting_) {
                halt("protocol.garbled_answer",
                     "an answer that no such machine gives: the line is disturbed, and what was "
                     "sent "
                     "cannot be trusted",
                     now);
            }
            break;
        default:
            take_facts(reply);
    }
}

void Grbl::on_ok(Instant now) {
    last_ok_ = now;
    if (check_ == Check::Entering) {
        check_ = Check::Reading;
        acked_ = next_ = first_;
        fill(now);
        return;
    }
    if (check_ == Check::Leaving) {
        check_ = Check::AwaitingBanner;
        return;
    }
    if (halting_) {
        return;
    }
    if (in_flight_.empty()) {
        halt("protocol.garbled_answer",
             "one answer more than lines were sent: the line is disturbed", now);
        return;
    }
    bytes_in_flight_ -= in_flight_.front();
    in_flight_.pop_front();
    ++acked_;
    if (phase_ != Phase::Checking &&
        (job_.kind(acked_ - 1) == LineKind::Drain || job_.kind(acked_ - 1) == LineKind::Ask)) {
        settle(now);
        return;
    }
    fill(now);
}

/// All motion is done; the next report of an idle machine says where it stands.
void Grbl::settle(Instant now) {
    settling_ = true;
    settle_since_ = now;
    out_.urgent += '?';
    last_poll_ = now;
}

void Grbl::settled(Instant now) {
    settling_ = false;
    const std::size_t entry = acked_ - 1;
    const AxisValues* expected = job_.expected(entry);
    for (std::size_t axis = 0; expected != nullptr && axis < static_cast<std::size_t>(status_.axes);
         ++axis) {
        const double off = std::abs(expected->at(axis) - status_.position_mm.at(axis));
        if (!std::isnan(expected->at(axis)) && off > options_.position_tolerance_mm) {
            halt("protocol.position_differs",
                 "the machine stands " + std::to_string(off) +
                     " mm from where the job should be on " +
                     std::string(1, identity_.axes.size() > axis ? identity_.axes[axis] : '?') +
                     ": a line was changed on its way",
                 now);
            return;
        }
    }
    if (job_.kind(entry) == LineKind::Ask && phase_ == Phase::Running) {
        phase_ = Phase::Asking;
        emit(Event::Kind::Asked, job_.question(entry), static_cast<long>(entry));
        return;
    }
    fill(now);
}

void Grbl::on_error(int number, Instant now) {
    const std::string words = grbl_error_words(number);
    if (phase_ == Phase::Checking && check_ != Check::Reading) {
        fail("protocol.check_failed", "the controller refuses its check mode: " + words);
        return;
    }
    if (halting_) {
        return;
    }
    const std::string where = in_flight_.empty() ? "a line that was not sent" : entry_words(acked_);
    if (phase_ == Phase::Checking) {
        fail("protocol.check_failed", where + ": " + words + "; nothing has moved");
        out_.discard = true;
        out_.urgent += '\x18';
        return;
    }
    // The lines behind it are in the controller's buffer and would run on.
    halt("protocol.machine_error", where + ": " + words, now);
}

void Grbl::on_banner(Instant now) {
    if (check_ == Check::AwaitingBanner || check_ == Check::Leaving) {
        emit(Event::Kind::Checked);
        begin_running(now);
        return;
    }
    if (halting_) {
        finish_halt();
        return;
    }
    out_.discard = true;
    fail("protocol.machine_reset",
         "the machine has restarted: job and position are lost, home again");
}

void Grbl::on_status(const GrblReply& reply, Instant now) {
    last_status_ = now;
    const double unit =
        identity_.settings.contains(13) && identity_.settings[13] != 0 ? kMmPerInch : 1;
    if (reply.work_offset) {
        AxisValues offset = *reply.work_offset;
        for (double& value : offset) {
            value *= unit;
        }
        work_offset_ = offset;
    }
    status_.state = reply.state;
    const bool placed = reply.has_work_position || (reply.has_machine_position && work_offset_);
    if (placed) {
        status_.axes = reply.axes;
        for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
            status_.position_mm.at(axis) =
                reply.position.at(axis) * unit -
                (reply.has_machine_position ? work_offset_->at(axis) : 0.0);
        }
    }
    status_.feed_override = reply.feed_override.value_or(status_.feed_override);
    ++status_.version;
    if (phase_ == Phase::Meeting) {
        return;
    }
    const std::string_view name = reply.state.substr(0, reply.state.find(':'));
    if (!idle_ && name == "Idle") {
        idle_since_ = now;
    }
    idle_ = name == "Idle";
    if (halting_) {
        if (idle_ || reply.state == "Hold:0" || reply.state == "Door:0" || name == "Alarm") {
            finish_halt();
        }
        return;
    }
    if (name == "Alarm") {
        out_.discard = true;
        fail("protocol.alarm",
             "the machine is in alarm: home or unlock it, then find its position");
        return;
    }
    const bool holds = name == "Hold" || name == "Door" || name == "Tool";
    if (phase_ == Phase::Running && holds) {
        phase_ = Phase::Paused;
        paused_here_ = false;
        emit(Event::Kind::Paused, "by the machine: " + std::string(reply.state));
    } else if (phase_ == Phase::Paused && !holds && now - pause_at_ > 2 * options_.poll) {
        phase_ = Phase::Running;
        emit(Event::Kind::Resumed, "at the machine");
        fill(now);
    }
    if (settling_ && placed && (idle_ || name == "Check")) {
        settled(now);
    }
}

/// Feed hold at once; reset when the machine stands, so that what it has in its buffer never runs.
void Grbl::halt(std::string code, std::string text, Instant now) {
    halting_ = true;
    halt_code_ = std::move(code);
    halt_text_ = std::move(text);
    halt_line_ = acked_;
    phase_ = Phase::Stopping;
    settling_ = false;
    out_.discard = true;
    out_.bytes.clear();
    out_.urgent += "!?";
    last_poll_ = now;
    halt_until_ = now + 2s;
}

void Grbl::finish_halt() {
    out_.urgent += '\x18';
    if (halt_code_.empty()) {
        phase_ = Phase::Stopped;
        emit(Event::Kind::Stopped, halt_text_);
        return;
    }
    phase_ = Phase::Failed;
    out_.events.push_back(
        {Event::Kind::Failed, halt_text_, halt_code_, static_cast<long>(halt_line_)});
}

std::string Grbl::entry_words(std::size_t entry) const {
    const long source = job_.source(entry);
    const std::string where =
        source > 0 ? "line " + std::to_string(source) : std::string("a line that Hew added");
    return where + " ('" + std::string(job_.text(entry)) + "')";
}

void Grbl::fail(std::string code, std::string text) {
    phase_ = Phase::Failed;
    out_.events.push_back(
        {Event::Kind::Failed, std::move(text), std::move(code), static_cast<long>(acked_)});
}

void Grbl::emit(Event::Kind kind, std::string text, long line) {
    out_.events.push_back({kind, std::move(text), {}, line});
}

Output Grbl::take_output() {
    Output out = std::move(out_);
    out_ = {};
    return out;
}

Progress Grbl::progress() const {
    Progress progress = counts_;
    progress.acked = phase_ == Phase::Checking ? 0 : acked_;
    progress.sent = phase_ == Phase::Checking ? 0 : next_;
    return progress;
}

void Grbl::allow(std::size_t entries, Instant now) {
    allowed_ = std::max(allowed_, entries);
    fill(now);
}

void Grbl::tick(Instant now) {
    if (phase_ == Phase::Meeting) {
        if (now >= step_until_) {
            if (step_ == Step::Banner) {
                enter(Step::Look, now);
            } else {
                say_step(now);
            }
        }
        return;
    }
    if (is_over(phase_) || phase_ == Phase::Closed || phase_ == Phase::Ready) {
        return;
    }
    if (now - last_poll_ >= options_.poll) {
        out_.urgent += '?';
        last_poll_ = now;
    }
    if (halting_) {
        if (now >= halt_until_) {
            finish_halt();
        }
        return;
    }
    if (check_ == Check::Entering || check_ == Check::Leaving || check_ == Check::AwaitingBanner) {
        if (now >= check_until_) {
            fail("protocol.check_failed", "the controller did not enter or leave its check mode");
        }
        return;
    }
    if (now - last_status_ >= options_.patience ||
        now - std::max(last_status_, last_ok_) >= 2 * options_.silence) {
        halt("protocol.machine_silent", "the machine does not report its state any more", now);
    } else if (!in_flight_.empty() && idle_ && now - std::max(idle_since_, last_ok_) >= kIdleWait) {
        halt("protocol.lost_count",
             "the machine is idle and " + std::to_string(in_flight_.size()) +
                 " lines are not answered: bytes were lost on the way",
             now);
    } else if (settling_ && now - settle_since_ >= options_.silence && idle_) {
        emit(Event::Kind::Warning, "the machine does not tell its work position: not compared");
        settled(now);
    }
}

std::optional<Instant> Grbl::deadline() const {
    if (phase_ == Phase::Meeting) {
        return step_until_;
    }
    if (is_over(phase_) || phase_ == Phase::Closed || phase_ == Phase::Ready) {
        return std::nullopt;
    }
    return halting_ ? std::min(halt_until_, last_poll_ + options_.poll)
                    : last_poll_ + options_.poll;
}

}  // namespace cam::protocol
