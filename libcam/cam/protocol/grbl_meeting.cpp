// SPDX-License-Identifier: GPL-3.0-or-later
// Meeting the controller, and what the operator wants.
#include "cam/protocol/grbl.h"

#include <algorithm>
#include <charconv>

namespace cam::protocol {

using namespace std::chrono_literals;

namespace {

constexpr Instant kStepWait = 1s;
constexpr int kStepTries = 5;
constexpr Instant kHomingWait = 5min;
constexpr char kFeedReset = '\x90';
constexpr char kFeedUp = '\x91';
constexpr char kFeedDown = '\x92';
constexpr double kMmPerInch = 25.4;

/// "V,15,128": the third field; grblHAL adds more.
std::size_t receive_bytes_of(std::string_view options) {
    for (int skipped = 0; skipped < 2; ++skipped) {
        const std::size_t comma = options.find(',');
        if (comma == std::string_view::npos) {
            return 0;
        }
        options.remove_prefix(comma + 1);
    }
    std::size_t bytes = 0;
    std::from_chars(options.data(), options.data() + options.size(), bytes);
    return bytes <= 65536 ? bytes : 0;
}

}  // namespace

void Grbl::meet(Meeting /*meeting*/, Instant now) {
    phase_ = Phase::Meeting;
    identity_ = {};
    splitter_.clear();
    in_flight_.clear();
    bytes_in_flight_ = 0;
    settling_ = halting_ = saw_banner_ = offers_homing_ = false;
    check_ = Check::None;
    work_offset_.reset();
    if (options_.expects_banner) {
        step_ = Step::Banner;
        step_until_ = now + options_.banner_wait;
    } else {
        enter(Step::Look, now);
    }
}

void Grbl::lose_link(Instant /*now*/) {
    if (!is_over(phase_)) {
        fail("protocol.link_lost",
             "the link is gone: these machines do not tell which line they had last");
    }
}

void Grbl::enter(Step step, Instant now) {
    step_ = step;
    step_tries_ = 0;
    if (step == Step::Done) {
        known();
        return;
    }
    say_step(now);
}

/// Everything is told. A machine that is locked until it is homed may be homed from here.
void Grbl::known() {
    const auto homing = identity_.settings.find(22);
    const bool can_home = homing != identity_.settings.end() && homing->second != 0;
    const bool alarmed = status_.state.starts_with("Alarm");
    identity_.homed = !alarmed;
    identity_.busy = !alarmed && !status_.state.starts_with("Idle");
    if (identity_.axes.empty()) {
        identity_.axes =
            std::string("XYZABC").substr(0, static_cast<std::size_t>(std::max(status_.axes, 3)));
    }
    if (alarmed && can_home && options_.offers_homing) {
        offers_homing_ = true;
        phase_ = Phase::Asking;
        emit(Event::Kind::Asked,
             "the machine is locked until it is homed. Home it now? It runs to its switches: its "
             "way must be free");
        return;
    }
    phase_ = Phase::Ready;
    emit(Event::Kind::Identified);
    emit(Event::Kind::Ready);
}

void Grbl::say_step(Instant now) {
    if (++step_tries_ > kStepTries) {
        fail(
            "protocol.no_answer",
            "the machine does not answer: is this its port, its baud rate, and is it switched on?");
        return;
    }
    if (step_ == Step::Homing) {
        if (step_tries_ > 1) {
            fail("protocol.homing_failed", "the machine has not finished its homing in 5 minutes");
            return;
        }
        step_until_ = now + kHomingWait;
        out_.bytes += "$H\n";
        return;
    }
    step_until_ = now + std::max(kStepWait, std::min(options_.silence, Instant(5s)));
    switch (step_) {
        case Step::Banner:
        case Step::Homing:
        case Step::Done:
            break;
        case Step::Look:
        case Step::Place:
            out_.urgent += '?';
            break;
        case Step::Version:
            out_.bytes += "$I\n";
            break;
        case Step::Settings:
            out_.bytes += "$$\n";
            break;
        case Step::Offsets:
            out_.bytes += "$#\n";
            break;
    }
}

void Grbl::meeting_reply(const GrblReply& reply, Instant now) {
    using Kind = GrblReply::Kind;
    take_facts(reply);
    if (reply.kind == Kind::Banner) {
        saw_banner_ = true;
        if (identity_.firmware.empty()) {
            identity_.firmware = reply.text.substr(0, reply.text.find(" ["));
        }
        if (step_ == Step::Banner) {
            enter(Step::Look, now);
        }
    } else if (reply.kind == Kind::Status && step_ == Step::Look) {
        // Positions are reported for every axis that the machine has.
        identity_.axes = std::string("XYZABC").substr(
            0, static_cast<std::size_t>(std::clamp(reply.axes, 0, static_cast<int>(kMaxAxes))));
        enter(Step::Version, now);
    } else if (reply.kind == Kind::Status && step_ == Step::Place) {
        enter(Step::Done, now);
    } else if (reply.kind == Kind::Ok || reply.kind == Kind::Error) {
        if (step_ == Step::Version) {
            enter(Step::Settings, now);
        } else if (step_ == Step::Settings) {
            enter(Step::Offsets, now);
        } else if (step_ == Step::Offsets) {
            // Once more: the first report can be one that an earlier program asked for.
            enter(Step::Place, now);
        } else if (step_ == Step::Homing && reply.kind == Kind::Ok) {
            enter(Step::Look, now);
        } else if (step_ == Step::Homing) {
            fail("protocol.homing_failed", "homing was refused: " + grbl_error_words(reply.number));
        }
    } else if (reply.kind == Kind::Alarm && step_ == Step::Homing) {
        fail("protocol.homing_failed", "homing failed: " + grbl_alarm_words(reply.number));
    }
}

void Grbl::take_facts(const GrblReply& reply) {
    using Kind = GrblReply::Kind;
    if (reply.kind == Kind::Version) {
        const std::size_t colon = std::min(reply.text.find(':'), reply.text.size());
        const std::string version(reply.text.substr(0, colon));
        if (identity_.firmware.empty()) {
            identity_.firmware = "Grbl " + version;
        }
        identity_.machine = reply.text.substr(std::min(colon + 1, reply.text.size()));
    } else if (reply.kind == Kind::Options) {
        identity_.receive_bytes = receive_bytes_of(reply.text);
    } else if (reply.kind == Kind::Axes && !reply.text.empty() && reply.text.size() <= kMaxAxes) {
        identity_.axes = reply.text;
    } else if (reply.kind == Kind::Setting && reply.count == 1 &&
               identity_.settings.size() < 1000) {
        identity_.settings[reply.number] = reply.values[0];
    } else if (reply.kind == Kind::Offset) {
        const bool inches = identity_.settings.contains(13) && identity_.settings[13] != 0;
        AxisValues& offset = identity_.offsets_mm[std::string(reply.text)];
        for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
            offset.at(axis) = reply.values.at(axis) * (inches ? kMmPerInch : 1);
        }
    }
}

void Grbl::wish(Wish wish, Instant now) {
    if (is_over(phase_) || phase_ == Phase::Closed) {
        return;
    }
    switch (wish) {
        case Wish::Stop:
        case Wish::Cancel:
            stop(wish, now);
            break;
        case Wish::Pause:
            // Also when it is believed to be paused: the machine knows better.
            if (phase_ == Phase::Running || phase_ == Phase::Paused) {
                out_.urgent += '!';
                pause_at_ = now;
            }
            if (phase_ == Phase::Running) {
                phase_ = Phase::Paused;
                paused_here_ = true;
                emit(Event::Kind::Paused, "by the operator; the spindle keeps turning");
            }
            break;
        case Wish::Resume:
            resume(now);
            break;
        case Wish::FeedUp:
            out_.urgent += kFeedUp;
            break;
        case Wish::FeedDown:
            out_.urgent += kFeedDown;
            break;
        case Wish::FeedReset:
            out_.urgent += kFeedReset;
            break;
        default:
            break;
    }
}

void Grbl::stop(Wish wish, Instant now) {
    const bool moving = phase_ == Phase::Running || phase_ == Phase::Paused ||
                        (phase_ == Phase::Asking && !offers_homing_) || phase_ == Phase::Checking ||
                        step_ == Step::Homing;
    if (!moving && phase_ != Phase::Stopping) {
        phase_ = Phase::Stopped;
        emit(Event::Kind::Stopped, "before the first line");
    } else if (!halting_) {
        halt({}, "by the operator: held, then reset; spindle and coolant are off", now);
        halt_until_ = now + (wish == Wish::Stop ? Instant(300ms) : Instant(2s));
        if (step_ == Step::Homing) {
            finish_halt();  // a homing cycle knows no hold
        }
    } else if (wish == Wish::Stop) {
        finish_halt();
    }
}

void Grbl::resume(Instant now) {
    if (offers_homing_) {
        offers_homing_ = false;
        phase_ = Phase::Meeting;
        enter(Step::Homing, now);
    } else if (phase_ == Phase::Paused) {
        out_.urgent += '~';
        pause_at_ = now;
        phase_ = Phase::Running;
        emit(Event::Kind::Resumed);
    } else if (phase_ == Phase::Asking) {
        phase_ = Phase::Running;
        last_ok_ = now;
        emit(Event::Kind::Resumed);
        fill(now);
    }
}

}  // namespace cam::protocol
