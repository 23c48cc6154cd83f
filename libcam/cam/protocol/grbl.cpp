// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/grbl.h"

#include <algorithm>
#include <cmath>

namespace cam::protocol {

using namespace std::chrono_literals;

namespace {

constexpr Instant kCheckWait = 5s;
constexpr Instant kIdleWait = 2s;  ///< idle with lines outstanding: answers or lines were lost

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
