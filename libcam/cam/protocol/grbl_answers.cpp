// SPDX-License-Identifier: GPL-3.0-or-later
// What the controller says in the middle of a job.
#include "cam/protocol/grbl.h"

#include <cmath>

namespace cam::protocol {

namespace {

constexpr double kMmPerInch = 25.4;

}  // namespace

void Grbl::reply(std::string_view line, Instant now) {
    using Kind = GrblReply::Kind;
    const GrblReply reply = read_grbl_reply(line);
    if (reply.kind == Kind::Status) {
        on_status(reply, now);
    }
    // Nothing of ours is on its way yet: answers are to lines of an earlier program.
    if (phase_ == Phase::Meeting || phase_ == Phase::Ready || offers_homing_) {
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
    if (phase_ == Phase::Meeting || offers_homing_) {
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
    // A report that was under way when the operator paused or resumed is no news.
    const bool fresh = now - pause_at_ > 2 * options_.poll;
    if (phase_ == Phase::Running && holds && fresh) {
        phase_ = Phase::Paused;
        paused_here_ = false;
        emit(Event::Kind::Paused, "by the machine: " + std::string(reply.state));
    } else if (phase_ == Phase::Paused && !holds && fresh) {
        phase_ = Phase::Running;
        emit(Event::Kind::Resumed, "at the machine");
        fill(now);
    }
    if (settling_ && placed && (idle_ || name == "Check")) {
        settled(now);
    }
}

}  // namespace cam::protocol
