// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/mailbox.h"

#include <algorithm>
#include <cmath>

namespace cam::protocol {

using namespace std::chrono_literals;

namespace {

constexpr Instant kQuickPoll = 1ms;
constexpr std::size_t kMostLinesInSlot = 255;
constexpr int kMostBackOff = 6;  ///< doublings of the silence

std::uint32_t number_of(const JobLines& job) {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < job.size(); ++i) {
        sum = crc32("\n", crc32(job.text(i), sum));
    }
    return sum == 0 ? 1 : sum;
}

}  // namespace

Mailbox::Mailbox(const JobLines& job, MailboxOptions options)
    : job_(job), options_(options), job_number_(number_of(job)) {
    counts_.total = job.size();
}

void Mailbox::emit(Event::Kind kind, std::string text, long line) {
    out_.events.push_back({kind, std::move(text), {}, line});
}

void Mailbox::fail(std::string code, std::string text) {
    if (is_over(phase_)) {
        return;
    }
    phase_ = Phase::Failed;
    out_.events.push_back(
        {Event::Kind::Failed, std::move(text), std::move(code), static_cast<long>(executed_)});
}

Output Mailbox::take_output() {
    Output out = std::move(out_);
    out_ = {};
    return out;
}

Progress Mailbox::progress() const {
    Progress progress = counts_;
    progress.acked = executed_;
    progress.sent = std::max(sent_, executed_);
    return progress;
}

std::uint16_t Mailbox::new_tag() {
    ++tag_;
    if (tag_ == 0) {
        tag_ = 1;
    }
    return tag_;
}

void Mailbox::send(Request request, const std::string& bytes, Instant now) {
    in_flight_ = request;
    out_.bytes += bytes;
    // The carrier answers within its timeout, also when nobody else does.
    guard_ = now + 4 * options_.timeout + 10s;
}

void Mailbox::ask_identity(Instant now) {
    const RegisterSpan span = identity_span(options_.map);
    send(Request::Identity, read_request(++request_tag_, options_.map.read_function, span), now);
}

void Mailbox::ask_status(Instant now) {
    const RegisterSpan span = status_span(options_.map);
    send(Request::Status, read_request(++request_tag_, options_.map.read_function, span), now);
}

/// Writes, and reads the status: at once where the machine can, else in a second request.
void Mailbox::exchange(std::uint16_t address, const Registers& values, Instant now) {
    if (!options_.map.combined) {
        send(Request::Write, write_request(++request_tag_, address, values), now);
        return;
    }
    const RegisterSpan span = status_span(options_.map);
    send(Request::Status,
         exchange_request(++request_tag_, address, values, span.address, span.count), now);
}

void Mailbox::beat(Instant now) { exchange(options_.map.at(Reg::Tag), {new_tag()}, now); }

void Mailbox::send_command(Instant now) {
    if (pending_->command == PlcCommand::Start && !job_written_) {
        Registers values(job_span(options_.map).count);
        put_long(options_.map, values, 0, job_number_);
        put_long(options_.map, values, 2, static_cast<std::uint32_t>(first_ + 1));
        put_long(options_.map, values, 4, static_cast<std::uint32_t>(job_.size()));
        put_long(options_.map, values, 6, job_number_);
        values[8] = static_cast<std::uint16_t>(std::min<long>(options_.watchdog / 1ms, 65535));
        send(Request::Job, write_request(++request_tag_, job_span(options_.map).address, values),
             now);
        return;
    }
    exchange(options_.map.at(Reg::Tag),
             {new_tag(), static_cast<std::uint16_t>(pending_->command), pending_->nonce}, now);
}

/// As many lines as fit into one slot and may go together.
std::size_t Mailbox::end_of_block() const {
    const std::size_t room = 2 * (plc_->slot_regs - kSlotHead);
    const std::size_t limit =
        std::min({job_.size(), allowed_, next_ + std::min(kMostLinesInSlot, queue_lines_)});
    std::size_t bytes = 0;
    std::size_t end = next_;
    while (end < limit) {
        const bool alone = job_.kind(end) != LineKind::Send;
        if ((alone && job_.kind(end) == LineKind::Alone && end > next_) ||
            bytes + job_.text(end).size() + 1 > room) {
            break;
        }
        bytes += job_.text(end).size() + 1;
        ++end;
        if (alone) {
            break;
        }
    }
    return end;
}

bool Mailbox::may_send() const {
    return phase_ == Phase::Running && ours_ && !barrier_ && blocks_.size() < plc_->slots &&
           next_ < std::min(job_.size(), allowed_);
}

void Mailbox::send_block(Instant now) {
    const std::size_t end = end_of_block();
    std::string lines;
    for (std::size_t i = next_; i < end; ++i) {
        lines += job_.text(i);
        lines += '\n';
    }
    const Registers values =
        slot_registers(options_.map, new_tag(), job_number_, static_cast<std::uint32_t>(next_ + 1),
                       static_cast<std::uint8_t>(end - next_), lines);
    const std::size_t slot = block_number_++ % plc_->slots;
    blocks_.push_back({next_, end - next_, now});
    if (sent_ > next_) {
        counts_.resent += static_cast<long>(std::min(sent_, end) - next_);
    }
    if (job_.kind(end - 1) != LineKind::Send) {
        barrier_ = end;
    }
    next_ = end;
    sent_ = std::max(sent_, end);
    exchange(static_cast<std::uint16_t>(options_.map.at(Reg::SlotArea) + slot * plc_->slot_regs),
             values, now);
}

/// Everything that was not taken is written again.
void Mailbox::go_back() {
    next_ = accepted_;
    blocks_.clear();
    if (barrier_ && *barrier_ > accepted_) {
        barrier_.reset();
    }
    if (accepted_ > passed_ && job_.kind(accepted_ - 1) != LineKind::Send) {
        barrier_ = accepted_;
    }
}

/// Silence, so that what is still on its way passes; then the machine is met again.
void Mailbox::recover(Instant now) {
    in_flight_.reset();
    step_ = Step::Silent;
    silent_until_ = now + 2 * options_.timeout * (1 << std::min(failures_, kMostBackOff));
    ++failures_;
    ++counts_.lost_answers;
}

void Mailbox::next(Instant now) {
    if (in_flight_ || step_ == Step::Down || is_over(phase_)) {
        return;
    }
    switch (step_) {
        case Step::Silent:
            if (now < silent_until_) {
                return;
            }
            step_ = Step::Identify;
            [[fallthrough]];
        case Step::Identify:
            ask_identity(now);
            return;
        case Step::First:
            ask_status(now);
            return;
        case Step::Confirm:
            if (now >= poll_at_) {
                exchange(options_.map.at(Reg::Tag), {confirm_tag_}, now);
            }
            return;
        default:
            work(now);
    }
}

void Mailbox::work(Instant now) {
    if (pending_) {
        // A new command leaves at once; it is said again until the machine shows it.
        if (now >= poll_at_ || !last_ || last_->nonce != pending_->nonce) {
            send_command(now);
        }
    } else if (override_) {
        exchange(options_.map.at(Reg::WishedOverride), {*override_}, now);
        override_.reset();
    } else if (may_send()) {
        send_block(now);
    } else if (now >= poll_at_) {
        beat(now);
    }
}

std::optional<Instant> Mailbox::deadline() const {
    if (step_ == Step::Down || is_over(phase_)) {
        return std::nullopt;
    }
    if (in_flight_) {
        return guard_;
    }
    return step_ == Step::Silent ? silent_until_ : poll_at_;
}

void Mailbox::tick(Instant now) {
    if (step_ == Step::Down || is_over(phase_)) {
        return;
    }
    if (in_flight_ && now >= guard_) {
        recover(now);
    }
    const bool meets = phase_ == Phase::Meeting;
    if (now - last_answer_ > (meets ? options_.meeting_wait : options_.patience)) {
        fail(meets ? "protocol.no_answer" : "protocol.machine_silent",
             meets ? "no machine answers to this unit number at the port"
                   : "the machine has stopped answering");
        return;
    }
    next(now);
}

void Mailbox::lose_link(Instant /*now*/) {
    in_flight_.reset();
    step_ = Step::Down;
}

void Mailbox::receive(std::string_view bytes, Instant now) {
    reader_.add(bytes);
    while (const auto got = reader_.next()) {
        if (in_flight_ && got->tag == request_tag_ && !is_over(phase_)) {
            answer(*got, now);
        } else {
            ++counts_.strange;
        }
    }
    if (!is_over(phase_)) {
        tick(now);
    }
}

void Mailbox::allow(std::size_t entries, Instant now) {
    allowed_ = std::max(allowed_, entries);
    next(now);
}

void Mailbox::order(PlcCommand command, Instant now) {
    if (++nonce_ == 0) {
        nonce_ = 1;
    }
    pending_ = Pending{command, nonce_, now};
    poll_gap_ = kQuickPoll;
    poll_at_ = now;
}

void Mailbox::wish(Wish wish, Instant now) {
    const bool works = ours_ && !is_over(phase_);
    switch (wish) {
        case Wish::Pause:
            if (works && phase_ == Phase::Running) {
                phase_ = Phase::Paused;
                order(PlcCommand::Hold, now);
            }
            break;
        case Wish::Resume:
            if (works && phase_ == Phase::Paused) {
                order(PlcCommand::Resume, now);
            } else if (works && phase_ == Phase::Asking) {
                phase_ = Phase::Running;
                if (machine_asks_) {
                    order(PlcCommand::ToolChanged, now);
                }
            }
            break;
        case Wish::Cancel:
        case Wish::Stop:
            if (!works && !pending_ && !is_over(phase_)) {
                phase_ = Phase::Stopped;
                emit(Event::Kind::Stopped, "nothing was sent");
            } else if (!is_over(phase_)) {
                kills_ = wish == Wish::Stop || kills_;
                phase_ = Phase::Stopping;
                order(kills_ ? PlcCommand::Abort : PlcCommand::Hold, now);
            }
            break;
        default:
            if (works) {
                const int step = wish == Wish::FeedUp ? 10 : -10;
                const int old = override_
                                    ? *override_
                                    : static_cast<int>(std::lround(100 * status_.feed_override));
                override_ = static_cast<std::uint16_t>(
                    wish == Wish::FeedReset ? 100 : std::clamp(old + step, 10, 200));
            }
    }
    next(now);
}

}  // namespace cam::protocol
