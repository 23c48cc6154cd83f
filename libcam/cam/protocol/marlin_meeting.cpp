// SPDX-License-Identifier: GPL-3.0-or-later
// Meeting the board, what the operator wants, and the passing of time.
#include "cam/protocol/marlin.h"

#include <algorithm>

namespace cam::protocol {

using namespace std::chrono_literals;

namespace {

constexpr Instant kQuiet = 50ms;  ///< before the same is asked again
constexpr Instant kLeastStepWait = 250ms;
constexpr Instant kStepWait = 2s;  ///< for the answer to a line while meeting
constexpr int kStepTries = 6;
constexpr Instant kTemperaturesEvery = 5s;
constexpr int kSilenceDoublings = 8;

}  // namespace

void Marlin::meet(Meeting meeting, Instant now) {
    phase_ = Phase::Meeting;
    meeting_ = meeting;
    if (meeting == Meeting::Fresh) {
        identity_ = {};
    }
    splitter_.clear();
    query_pending_ = fault_pending_ = step_refused_ = false;
    last_line_.reset();
    swallow_ok_ = 0;
    meeting_rounds_ = 0;
    hold_until_.reset();
    last_sign_ = last_send_ = now;
    if (options_.expects_banner) {
        step_ = Step::Banner;
        step_until_ = now + options_.banner_wait;
    } else {
        enter(first_step(), now);
    }
}

/// A board that is known is asked for its last line and for nothing else: the question for its name
/// has no number, and disturbed it could be another command.
Marlin::Step Marlin::first_step() const {
    if (meeting_ == Meeting::Fresh) {
        return Step::Clear;
    }
    return identity_.firmware.empty() ? Step::Name : Step::Confirm;
}

void Marlin::enter(Step step, Instant now) {
    step_ = step;
    step_tries_ = 0;
    say_step(now);
}

void Marlin::say_step(Instant now) {
    if (++step_tries_ > kStepTries) {
        fail(
            "protocol.no_answer",
            "the machine does not answer: is this its port, its baud rate, and is it switched on?");
        return;
    }
    step_until_ = now + std::clamp(options_.silence, kLeastStepWait, kStepWait);
    step_refused_ = false;
    last_send_ = now;
    switch (step_) {
        case Step::Banner:
            break;
        case Step::Clear:
            out_.bytes +=
                "\n" + numbered_line(kMeetingNumber, "M110 N" + std::to_string(kMeetingNumber));
            break;
        case Step::Name:
            out_.bytes +=
                meeting_ == Meeting::Again ? "\nM115\n" : numbered_line(kMeetingNumber + 1, "M115");
            break;
        case Step::Autoreport:
            out_.bytes += numbered_line(kMeetingNumber + 2, "M155 S1");
            break;
        case Step::ReportPlace:
            out_.bytes += numbered_line(kMeetingNumber + (polls_ ? 2 : 3), "M154 S1");
            break;
        case Step::Number: {
            const std::string before = std::to_string(kFirstNumber - 1);
            out_.bytes += numbered_line(kFirstNumber - 1, "M110 N" + before);
            break;
        }
        case Step::Confirm:
            out_.bytes += "\n" + numbered_line(kQueryNumber, "M105");
            break;
    }
}

void Marlin::next_step(Instant now) {
    const auto can = [this](const char* capability) {
        const auto told = identity_.capabilities.find(capability);
        return told != identity_.capabilities.end() && told->second == "1";
    };
    switch (step_) {
        case Step::Banner:
        case Step::Clear:
            enter(Step::Name, now);
            break;
        case Step::Name: {
            emit(Event::Kind::Identified);
            polls_ = !can("AUTOREPORT_TEMP");
            if (meeting_ == Meeting::Again) {
                enter(Step::Confirm, now);
            } else if (!polls_) {
                enter(Step::Autoreport, now);
            } else {
                enter(can("AUTOREPORT_POS") ? Step::ReportPlace : Step::Number, now);
            }
            break;
        }
        case Step::Autoreport:
            enter(can("AUTOREPORT_POS") ? Step::ReportPlace : Step::Number, now);
            break;
        case Step::ReportPlace:
            enter(Step::Number, now);
            break;
        case Step::Number:
        case Step::Confirm:
            enter(Step::Confirm, now);
            break;
    }
}

void Marlin::meeting_reply(const MarlinReply& reply, Instant now) {
    using Kind = MarlinReply::Kind;
    if (reply.kind == Kind::Firmware) {
        identity_.firmware = firmware_field(reply.text, "FIRMWARE_NAME");
        identity_.machine = firmware_field(reply.text, "MACHINE_TYPE");
    } else if (reply.kind == Kind::Capability) {
        const std::size_t colon = std::min(reply.text.find(':'), reply.text.size());
        const std::string name(reply.text.substr(0, colon));
        const std::string value(reply.text.substr(std::min(colon + 1, reply.text.size())));
        if (identity_.capabilities.size() < 200) {
            identity_.capabilities[name] = value;
        }
        identity_.emergency_parser =
            identity_.emergency_parser || (name == "EMERGENCY_PARSER" && value == "1");
    } else if (reply.kind == Kind::Resend) {
        step_refused_ = true;
        if (reply.number && step_ == Step::Confirm) {
            // Believed when two say the same: the error and the request, or two requests.
            const bool twice = last_line_ && *last_line_ + 1 == *reply.number;
            last_line_ = *reply.number - 1;
            if (twice) {
                swallow_ok_ = 1;
                confirmed(*reply.number, now);
            } else {
                step_until_ = now + kQuiet;
            }
        }
    } else if (reply.kind == Kind::LineFault) {
        step_refused_ = true;
        last_line_ = reply.number;
    } else if (reply.kind == Kind::Busy) {
        step_until_ = now + kStepWait;
    } else if (reply.kind == Kind::Ok && step_ != Step::Banner) {
        if (swallow_ok_ > 0) {
            --swallow_ok_;
        } else if (step_ == Step::Confirm) {
            if (!step_refused_ && meeting_ == Meeting::Again && !reply.heaters.empty()) {
                fail("protocol.machine_reset",
                     "the machine was reset since the job stopped: it does not know its lines");
            }
        } else if (step_ == Step::Name && identity_.firmware.empty()) {
            if (++meeting_rounds_ > kStepTries) {
                fail("protocol.no_answer", "the machine does not tell its name (M115)");
                return;
            }
            enter(meeting_ == Meeting::Again ? Step::Name : Step::Clear, now);
        } else if (step_refused_ && step_ != Step::Name && step_ != Step::Autoreport &&
                   step_ != Step::ReportPlace) {
            say_step(now);
        } else {
            next_step(now);
        }
    }
}

void Marlin::confirmed(long next_number, Instant now) {
    const long has = next_number - kFirstNumber;
    if (meeting_ == Meeting::Fresh) {
        if (has != 0) {
            enter(Step::Number, now);
            return;
        }
    } else if (has < 0 || has > static_cast<long>(job_.size())) {
        fail(next_number <= 3 ? "protocol.machine_reset" : "protocol.lost_count",
             "the machine's last line is number " + std::to_string(next_number - 1) +
                 ", which is not of this job");
        return;
    }
    last_line_.reset();
    phase_ = Phase::Ready;
    emit(Event::Kind::Ready, {}, has);
}

void Marlin::wish(Wish wish, Instant now) {
    if (is_over(phase_) || phase_ == Phase::Closed) {
        return;
    }
    switch (wish) {
        case Wish::Stop:
            stop(now);
            break;
        case Wish::Cancel:
            cancel(now);
            break;
        case Wish::Pause:
            if (phase_ == Phase::Running) {
                pause("by the operator; motion that the machine has already taken is finished");
            }
            break;
        case Wish::Resume:
            resume(now);
            break;
        case Wish::FeedUp:
        case Wish::FeedDown:
        case Wish::FeedReset:
            change_feed(wish, now);
            break;
        default:
            choose(static_cast<int>(wish) - static_cast<int>(Wish::FirstChoice), now);
    }
}

void Marlin::pause(const std::string& why) {
    if (phase_ == Phase::Running) {
        phase_ = Phase::Paused;
        emit(Event::Kind::Paused, why);
    }
}

void Marlin::resume(Instant now) {
    if (prompted_) {
        choose(0, now);
        return;
    }
    if (asks_for_m108_) {
        asks_for_m108_ = false;
        out_.urgent += "\nM108\n";
        return;
    }
    if (phase_ == Phase::Paused || phase_ == Phase::Asking) {
        phase_ = Phase::Running;
        emit(Event::Kind::Resumed);
        last_sign_ = now;
        fill(now);
        check_end(now);
    }
}

void Marlin::cancel(Instant now) {
    if (phase_ == Phase::Meeting || phase_ == Phase::Ready) {
        phase_ = Phase::Stopped;
        emit(Event::Kind::Stopped, "before the first line");
        return;
    }
    if (phase_ == Phase::Stopping) {
        return;
    }
    phase_ = Phase::Stopping;
    cut_ = sent_;
    tail_ = {"M104 S0", "M140 S0", "M107"};
    if (identity_.emergency_parser) {
        // Ends waiting for heaters, and the motion that is planned.
        out_.urgent += "\nM108\nM410\n";
    }
    stop_until_ = now + options_.patience;
    fill(now);
}

void Marlin::silence(Instant now) {
    if (now - last_sign_ >= options_.patience) {
        fail("protocol.machine_silent",
             "the machine has not answered for " + std::to_string((now - last_sign_) / 1s) + " s");
        return;
    }
    silence_ = std::min(2 * silence_, kSilenceDoublings * options_.silence);
    swallow_ok_ = 0;
    fault_pending_ = false;
    last_line_.reset();
    query(now);
}

void Marlin::tick(Instant now) {
    if (hold_until_ && now >= *hold_until_) {
        hold_until_.reset();
        swallow_ok_ = 0;
        if (acked_ < next_) {
            query(now);
        }
        fill(now);
    }
    if (phase_ == Phase::Meeting && now >= step_until_) {
        if (step_ == Step::Banner) {
            enter(first_step(), now);
        } else {
            swallow_ok_ = 0;
            say_step(now);
        }
    }
    if (polls_ && may_talk_aside() && now >= poll_at_) {
        poll_at_ = now + kTemperaturesEvery;
        add_aside("M105", now);
    }
    if (phase_ == Phase::Stopping && now >= stop_until_) {
        phase_ = Phase::Stopped;
        emit(Event::Kind::Stopped, "the machine did not confirm");
    }
    if (waits_for_answer() && now >= std::max(last_sign_, last_send_) + silence_) {
        silence(now);
    }
}

bool Marlin::waits_for_answer() const {
    const bool at_work = phase_ == Phase::Running || phase_ == Phase::Stopping ||
                         phase_ == Phase::Paused || phase_ == Phase::Asking;
    return !killed_ && at_work && (acked_ < next_ || query_pending_ || !aside_.empty());
}

std::optional<Instant> Marlin::deadline() const {
    std::optional<Instant> soonest = hold_until_;
    const auto consider = [&](Instant when) { soonest = std::min(soonest.value_or(when), when); };
    if (phase_ == Phase::Meeting) {
        consider(step_until_);
    }
    if (phase_ == Phase::Stopping) {
        consider(stop_until_);
    }
    if (polls_ && may_talk_aside()) {
        consider(poll_at_);
    }
    if (waits_for_answer()) {
        consider(std::max(last_sign_, last_send_) + silence_);
    }
    return soonest;
}

}  // namespace cam::protocol
