// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/marlin.h"

#include <algorithm>

namespace cam::protocol {

using namespace std::chrono_literals;

namespace {

constexpr Instant kQuiet = 50ms;       ///< for stray lines of a window to be refused
constexpr int kResendsOfOneLine = 10;  ///< more: the link is not usable
constexpr std::size_t kResendSpan = 100;
constexpr int kBadResends = 3;
constexpr std::size_t kFarthestBack = 1000;  ///< entries that a request may go back

}  // namespace

Marlin::Marlin(const JobLines& job, LinkOptions options)
    : job_(job), options_(options), cut_(job.size()) {
    counts_.total = job.size();
    silence_ = options_.silence;
}

void Marlin::run(std::size_t first, Instant now) {
    if (phase_ != Phase::Ready) {
        return;
    }
    // What has left before the link was lost has left: the board may have it.
    sent_ = std::max(sent_, first);
    acked_ = next_ = first;
    phase_ = Phase::Running;
    window_ = 1;
    last_sign_ = last_send_ = poll_at_ = now;
    fill(now);
    check_end(now);
}

void Marlin::lose_link(Instant /*now*/) {
    if (is_over(phase_)) {
        return;
    }
    phase_ = Phase::Closed;
    splitter_.clear();
    query_pending_ = fault_pending_ = false;
    swallow_ok_ = late_temperatures_ = 0;
    asides_.clear();
    aside_.clear();
    hold_until_.reset();
}

void Marlin::receive(std::string_view bytes, Instant now) {
    while (splitter_.next(bytes)) {
        if (phase_ != Phase::Closed && !is_over(phase_)) {
            reply(splitter_.line(), now);
        }
    }
}

void Marlin::reply(std::string_view line, Instant now) {
    const MarlinReply reply = read_marlin_reply(line);
    using Kind = MarlinReply::Kind;
    if (reply.kind != Kind::Text) {
        last_sign_ = now;
        silence_ = options_.silence;
    }
    take_report(reply);
    if (reply.kind == Kind::Banner) {
        on_banner(now);
        return;
    }
    if (reply.kind == Kind::Fatal) {
        if (phase_ == Phase::Stopping) {
            phase_ = Phase::Stopped;
            emit(Event::Kind::Stopped, std::string(reply.text));
        } else {
            fail("protocol.machine_fault", "the machine says: " + std::string(reply.text));
        }
        return;
    }
    if (phase_ == Phase::Meeting) {
        meeting_reply(reply, now);
        return;
    }
    switch (reply.kind) {
        case Kind::Ok:
            on_ok(reply, now);
            break;
        case Kind::LineFault:
            fault_pending_ = true;
            last_line_ = reply.number;
            break;
        case Kind::Resend:
            on_resend(reply, now);
            break;
        case Kind::Wait:
            if (acked_ < next_ && !query_pending_) {
                query(now);
            }
            break;
        case Kind::WaitsForUser:
            if (!asks_for_m108_) {
                asks_for_m108_ = true;
                emit(Event::Kind::Asked, "the machine waits: " + std::string(reply.text));
            }
            break;
        case Kind::Action:
            on_action(reply.text, now);
            break;
        case Kind::Fault:
            emit(Event::Kind::Warning, "the machine says: " + std::string(reply.text));
            break;
        case Kind::Text:
            counts_.strange += reply.text.starts_with("echo:") ? 0 : 1;
            break;
        default:
            break;
    }
}

void Marlin::take_report(const MarlinReply& reply) {
    if (!reply.heaters.empty()) {
        status_.heaters = reply.heaters;
        ++status_.version;
    }
    if (reply.position_mm) {
        status_.position_mm = *reply.position_mm;
        status_.axes = 3;
        position_told_ = true;
        ++status_.version;
    }
    if (reply.feed_percent) {
        status_.feed_override = *reply.feed_percent / 100;
        ++status_.version;
    }
}

void Marlin::on_ok(const MarlinReply& reply, Instant now) {
    asks_for_m108_ = false;
    if (swallow_ok_ > 0) {
        --swallow_ok_;
        if (!strays_) {
            hold_until_.reset();
        }
        if (acked_ < next_ && !query_pending_ && !killed_) {
            query(now);
        }
    } else if (reply.number) {
        const long entries = *reply.number - kFirstNumber + 1;
        if (entries > static_cast<long>(acked_) && entries <= static_cast<long>(next_)) {
            acknowledge(static_cast<std::size_t>(entries), now);
        }
        // The board tells which line it answers for: more than one may travel.
        window_ = options_.window;
    } else if (fault_pending_) {
        // The answer to a refused line whose number was lost on the way.
        fault_pending_ = false;
        query(now);
    } else if (!aside_.empty() && acked_ == next_ && !query_pending_) {
        aside_answered();
    } else if (late_temperatures_ > 0 && !reply.heaters.empty()) {
        --late_temperatures_;
    } else if (query_pending_ && !reply.heaters.empty() &&
               (acked_ >= next_ || !text(acked_).starts_with("M105"))) {
        fail("protocol.machine_reset",
             "the machine took line number 1: it was reset and does not know the job any more");
    } else if (acked_ < next_) {
        acknowledge(acked_ + 1, now);
    }
    fill(now);
}

void Marlin::acknowledge(std::size_t entries, Instant now) {
    const bool forward = entries > acked_;
    acked_ = entries;
    bad_resends_ = 0;
    if (acked_ == next_) {
        bytes_in_flight_ = 0;
    }
    if (forward && acked_ <= cut_ && job_.expected(acked_ - 1) != nullptr) {
        compare_position(acked_ - 1);
    }
    if (forward && kind(acked_ - 1) == LineKind::Ask && phase_ == Phase::Running) {
        phase_ = Phase::Asking;
        emit(Event::Kind::Asked, job_.question(acked_ - 1), static_cast<long>(acked_ - 1));
    }
    check_end(now);
}

void Marlin::on_resend(const MarlinReply& reply, Instant now) {
    swallow_ok_ = 1;
    const bool contradicts = last_line_ && reply.number && *last_line_ + 1 != *reply.number;
    const bool readable = reply.number.has_value() && !contradicts;
    fault_pending_ = false;
    last_line_.reset();
    const long has = reply.number.value_or(0) - kFirstNumber;
    const long lowest =
        static_cast<long>(acked_) - static_cast<long>(std::min(acked_, kFarthestBack));
    if (!readable || has < lowest || has > static_cast<long>(std::max(sent_, next_))) {
        ++counts_.strange;
        hold_until_ = now + kQuiet;
        strays_ = false;
        query_pending_ = false;
        if (readable && ++bad_resends_ >= kBadResends) {
            fail(*reply.number <= 3 ? "protocol.machine_reset" : "protocol.lost_count",
                 "the machine asks for line " + std::to_string(*reply.number) +
                     ", which is none of " +
                     "those under way: it was reset, or another program has spoken to it");
        }
        return;
    }
    go_back(static_cast<std::size_t>(has), now);
}

void Marlin::go_back(std::size_t entries, Instant now) {
    bad_resends_ = 0;
    if (query_pending_) {
        query_pending_ = false;
        counts_.lost_answers += entries > acked_ ? 1 : 0;
    }
    const bool again = entries < next_;
    if (again) {
        counts_.resent += static_cast<long>(next_ - entries);
    }
    strays_ = next_ > entries + 1;
    next_ = entries;
    acknowledge(entries, now);
    bytes_in_flight_ = 0;
    window_ = 1;
    hold_until_ = now + kQuiet;
    if (again) {
        count_resend(now);
    }
}

void Marlin::count_resend(Instant /*now*/) {
    resends_of_line_ = next_ == resent_line_ ? resends_of_line_ + 1 : 1;
    resent_line_ = next_;
    recent_resends_.push_back(next_);
    std::erase_if(recent_resends_,
                  [this](std::size_t entry) { return entry + kResendSpan < next_; });
    emit(Event::Kind::Resent, {}, static_cast<long>(next_));
    const auto most = static_cast<std::size_t>(options_.max_resend_fraction * kResendSpan);
    if (resends_of_line_ > kResendsOfOneLine) {
        resends_of_line_ = 0;
        pause("one line had to be sent more than 10 times: check cable, baud rate and shielding");
    } else if (recent_resends_.size() > most && options_.max_resend_fraction < 1) {
        recent_resends_.clear();
        pause("more than " + std::to_string(most) +
              " of 100 lines had to be sent again: check cable, baud rate and shielding");
    }
}

void Marlin::on_banner(Instant now) {
    if (phase_ == Phase::Meeting && meeting_ == Meeting::Fresh) {
        enter(Step::Clear, now);
        return;
    }
    if (phase_ == Phase::Stopping) {
        phase_ = Phase::Stopped;
        emit(Event::Kind::Stopped, "the machine has restarted");
        return;
    }
    fail("protocol.machine_reset",
         "the machine has restarted: it has lost the job, its position and its heaters' targets");
}

void Marlin::query(Instant now) {
    query_pending_ = true;
    if (!aside_.empty()) {
        late_temperatures_ += aside_ == "M105" ? 1 : 0;
        aside_.clear();
    }
    // The newline ends what may have been left of a line whose end was lost.
    out_.bytes += "\n" + numbered_line(kQueryNumber, "M105");
    last_send_ = now;
}

bool Marlin::may_send() const {
    if (next_ >= end() || hold_until_ || query_pending_ || !aside_.empty() ||
        (!asides_.empty() && phase_ != Phase::Stopping) ||
        (phase_ == Phase::Paused && next_ >= sent_)) {
        return false;
    }
    if (phase_ != Phase::Running && phase_ != Phase::Stopping && phase_ != Phase::Paused) {
        return false;
    }
    if (next_ >= allowed_ && next_ < cut_) {
        return false;
    }
    const std::size_t in_flight = next_ - acked_;
    if (in_flight == 0) {
        return true;
    }
    return in_flight < static_cast<std::size_t>(window_) && kind(next_) == LineKind::Send &&
           kind(next_ - 1) == LineKind::Send &&
           bytes_in_flight_ + text(next_).size() + 16 <= options_.receive_bytes;
}

void Marlin::fill(Instant now) {
    if (may_send_aside()) {
        send_aside(now);
    }
    while (may_send()) {
        send_entry(now);
    }
}

void Marlin::send_entry(Instant now) {
    const std::string line = numbered_line(kFirstNumber + static_cast<long>(next_), text(next_));
    bytes_in_flight_ += line.size();
    out_.bytes += line;
    position_told_ = false;
    ++next_;
    sent_ = std::max(sent_, next_);
    last_send_ = now;
}

void Marlin::check_end(Instant /*now*/) {
    if (acked_ < end() || killed_) {
        return;
    }
    if (phase_ == Phase::Stopping) {
        phase_ = Phase::Stopped;
        emit(Event::Kind::Stopped, "the job was cancelled; heaters and fan are off");
    } else if (phase_ == Phase::Running) {
        phase_ = Phase::Finished;
        emit(Event::Kind::Finished);
    }
}

std::string_view Marlin::text(std::size_t entry) const {
    return entry < cut_ ? job_.text(entry) : std::string_view(tail_[entry - cut_]);
}

LineKind Marlin::kind(std::size_t entry) const {
    return entry < cut_ ? job_.kind(entry) : LineKind::Send;
}

void Marlin::allow(std::size_t entries, Instant now) {
    allowed_ = std::max(allowed_, entries);
    fill(now);
}

Output Marlin::take_output() {
    Output out = std::move(out_);
    out_ = {};
    return out;
}

Progress Marlin::progress() const {
    Progress progress = counts_;
    progress.acked = std::min(acked_, cut_);
    progress.sent = std::min(sent_, cut_);
    return progress;
}

void Marlin::fail(std::string code, std::string text) {
    phase_ = Phase::Failed;
    out_.events.push_back(
        {Event::Kind::Failed, std::move(text), std::move(code), static_cast<long>(acked_)});
}

void Marlin::emit(Event::Kind kind, std::string text, long line) {
    out_.events.push_back({kind, std::move(text), {}, line});
}

}  // namespace cam::protocol
