// SPDX-License-Identifier: GPL-3.0-or-later
// What the machine's answers mean.
#include "cam/protocol/mailbox.h"

#include <algorithm>
#include <cmath>

namespace cam::protocol {

using namespace std::chrono_literals;

namespace {

constexpr Instant kQuickPoll = 1ms;
constexpr std::uint16_t kInputHomed = 4;
constexpr std::uint16_t kPayloadText = 1;
constexpr std::uint16_t kGap = 2;
constexpr std::uint16_t kDamaged = 3;
constexpr std::uint8_t kIllegalFunction = 1;
constexpr std::uint8_t kIllegalAddress = 2;
constexpr std::uint8_t kIllegalValue = 3;

std::string_view state_name(PlcState state) {
    constexpr std::array<std::string_view, 8> kNames = {"Init",  "Idle",  "Run",  "Hold",
                                                        "Alarm", "EStop", "Tool", "Done"};
    return kNames.at(static_cast<std::size_t>(state));
}

bool shows(PlcState state, PlcCommand command) {
    const bool rests = state == PlcState::Idle || state == PlcState::Done ||
                       state == PlcState::Alarm || state == PlcState::EmergencyStop;
    switch (command) {
        case PlcCommand::Hold:
            return state == PlcState::Hold || rests;
        case PlcCommand::Start:
        case PlcCommand::Resume:
            return state == PlcState::Run || state == PlcState::ToolChange ||
                   state == PlcState::Done;
        case PlcCommand::Abort:
            return rests;
        case PlcCommand::ToolChanged:
            return state != PlcState::ToolChange;
        default:
            return true;
    }
}

}  // namespace

void Mailbox::meet(Meeting meeting, Instant now) {
    meeting_ = meeting;
    in_flight_.reset();
    blocks_.clear();
    pending_.reset();
    reader_ = {};
    ours_ = false;
    phase_ = Phase::Meeting;
    step_ = Step::Identify;
    last_answer_ = now;
    failures_ = 0;
    next(now);
}

void Mailbox::answer(const ModbusAnswer& answer, Instant now) {
    const Request request = *in_flight_;
    in_flight_.reset();
    if (answer.no_answer) {
        recover(now);
        return;
    }
    if (answer.exception != 0) {
        in_flight_ = request;
        exception(answer, now);
        return;
    }
    last_answer_ = now;
    switch (request) {
        case Request::Identity:
            on_identity(answer.registers, now);
            break;
        case Request::Job:
            job_written_ = true;
            break;
        case Request::Write:
            ask_status(now);
            break;
        case Request::Status:
            on_status(answer.registers, now);
            break;
    }
}

void Mailbox::exception(const ModbusAnswer& answer, Instant now) {
    const Request request = *in_flight_;
    in_flight_.reset();
    last_answer_ = now;
    if (answer.exception == kIllegalFunction && request == Request::Status &&
        options_.map.combined && step_ != Step::First) {
        options_.map.combined = false;
        emit(Event::Kind::Notice, "the machine lacks function 23: 16 and 3 are used");
        // What was on its way was not written; it is asked for again from what was taken.
        go_back();
        return;
    }
    if (answer.exception == kIllegalFunction || answer.exception == kIllegalAddress ||
        answer.exception == kIllegalValue) {
        fail("protocol.refused", "the machine refuses a request with Modbus exception " +
                                     std::to_string(answer.exception) +
                                     ": its registers are not those of the profile");
        return;
    }
    recover(now);
}

void Mailbox::on_identity(const Registers& in, Instant now) {
    const auto plc = read_identity(options_.map, in);
    if (!plc) {
        recover(now);
        return;
    }
    if (plc->magic != kMailboxMagic || plc->version != kMailboxVersion) {
        fail("protocol.no_mailbox", "there is no G-code mailbox of version 1 at these registers");
        return;
    }
    const bool met = phase_ != Phase::Meeting;
    if (plc_ && plc->boot_id != plc_->boot_id && (met || meeting_ == Meeting::Again)) {
        fail("protocol.machine_reset",
             "the controller has restarted: its position and modes are not those of the job");
        return;
    }
    if (plc->slots < 2 || plc->slot_regs <= kSlotHead || plc->slot_regs > kMostWriteRegisters ||
        (plc->payloads & kPayloadText) == 0) {
        fail("protocol.no_mailbox",
             "the mailbox has too few slots, slots of a wrong size, or takes no text");
        return;
    }
    plc_ = plc;
    if (met) {
        confirm_tag_ = new_tag();
        step_ = Step::Confirm;
        poll_at_ = now;
        poll_gap_ = kQuickPoll;
        return;
    }
    const std::size_t room = 2U * (plc->slot_regs - kSlotHead);
    for (std::size_t i = 0; i < job_.size(); ++i) {
        if (job_.text(i).size() + 1 > room) {
            fail("protocol.line_too_long", "line " + std::to_string(job_.source(i)) +
                                               " is longer than a slot of the machine");
            return;
        }
    }
    step_ = Step::First;
}

void Mailbox::on_status(const Registers& in, Instant now) {
    const auto status = read_status(options_.map, in);
    if (!status) {
        recover(now);
        return;
    }
    queue_lines_ = std::max<std::size_t>(queue_lines_, status->free_lines);
    if (step_ == Step::First) {
        tag_ = echo_ = status->tag;
        nonce_ = status->nonce;
        confirm_tag_ = new_tag();
        step_ = Step::Confirm;
        poll_at_ = now;
        poll_gap_ = kQuickPoll;
        return;
    }
    const bool changed = !last_ || status->accepted != last_->accepted ||
                         status->executed != last_->executed || status->state != last_->state;
    poll_gap_ = changed ? kQuickPoll : std::min(2 * poll_gap_, options_.poll);
    poll_at_ = now + poll_gap_;
    if (step_ == Step::Confirm) {
        if (status->tag != confirm_tag_) {
            return;
        }
        step_ = Step::Working;
        failures_ = 0;
        echo_ = confirm_tag_;
        if (phase_ == Phase::Meeting) {
            take_status(*status);
            meet_status(*status, now);
            return;
        }
        go_back();
    }
    // An answer to an older request shows a tag from before the last one that was believed.
    if (static_cast<std::uint16_t>(status->tag - echo_) >
        static_cast<std::uint16_t>(tag_ - echo_)) {
        ++counts_.strange;
        recover(now);
        return;
    }
    echo_ = status->tag;
    take_status(*status);
    follow_command(*status, now);
    if (ours_ && !is_over(phase_) && follow_count(*status, now)) {
        follow_barrier(*status);
        follow_state(*status, now);
    }
}

void Mailbox::take_status(const PlcStatus& status) {
    Status out;
    out.state = state_name(status.state);
    out.axes = static_cast<int>(kMaxAxes);
    std::copy(status.position_mm.begin(), status.position_mm.end(), out.position_mm.begin());
    out.feed_override = status.feed_override;
    out.version = status_.version;
    if (out.state != status_.state || out.position_mm != status_.position_mm ||
        out.feed_override != status_.feed_override) {
        ++out.version;
    }
    status_ = out;
    last_ = status;
}

void Mailbox::meet_status(const PlcStatus& status, Instant /*now*/) {
    const bool knows = status.job == job_number_;
    const bool works = status.state == PlcState::Run || status.state == PlcState::Hold ||
                       status.state == PlcState::ToolChange;
    identity_.firmware = "G-code mailbox " + std::to_string(plc_->version);
    identity_.axes = "XYZABC";
    identity_.homed = (status.inputs & kInputHomed) != 0;
    identity_.busy = works && !(knows && meeting_ == Meeting::Again);
    emit(Event::Kind::Identified);
    if (meeting_ == Meeting::Again && (!knows || status.error == kErrorRestarted)) {
        fail("protocol.machine_reset",
             "the controller no longer works on this job: it was restarted or given another one");
        return;
    }
    if (status.state == PlcState::Alarm || status.state == PlcState::EmergencyStop) {
        fail("protocol.alarm", "the machine is in alarm: " + plc_error_text(status.error));
        return;
    }
    accepted_ = executed_ = 0;
    if (meeting_ == Meeting::Again) {
        if (status.accepted > job_.size() || status.executed > status.accepted) {
            fail("protocol.lost_count", "the machine has more lines than the job");
            return;
        }
        accepted_ = status.accepted;
        executed_ = status.executed;
    }
    phase_ = Phase::Ready;
    emit(Event::Kind::Ready, {}, static_cast<long>(accepted_));
}

void Mailbox::run(std::size_t first, Instant now) {
    phase_ = Phase::Running;
    next_ = sent_ = first_ = first;
    barrier_.reset();
    if (meeting_ == Meeting::Again && accepted_ == first) {
        ours_ = true;
        passed_ = 0;
        go_back();
        if (last_ && last_->state == PlcState::Hold) {
            order(PlcCommand::Resume, now);
        }
    } else {
        accepted_ = executed_ = passed_ = first;
        job_written_ = false;
        order(PlcCommand::Start, now);
    }
    next(now);
}

/// A command is done when its nonce has come back and the state shows it.
void Mailbox::follow_command(const PlcStatus& status, Instant now) {
    if (!pending_) {
        return;
    }
    const PlcCommand command = pending_->command;
    const bool taken = status.nonce == pending_->nonce;
    const bool started =
        command != PlcCommand::Start || (status.job == job_number_ && status.accepted == first_);
    if (taken && started && shows(status.state, command)) {
        pending_.reset();
        reached(command, now);
        return;
    }
    constexpr Instant kPatience = 5s;
    if (!taken || now - pending_->since < kPatience) {
        return;
    }
    if (command == PlcCommand::Hold || command == PlcCommand::Abort ||
        command == PlcCommand::Start) {
        // Said anew: an older sender may have used the same nonce.
        order(command, now);
        return;
    }
    pending_.reset();
    emit(Event::Kind::Warning, "the machine has not done what was asked for; it says " +
                                   status_.state + ", " + plc_error_text(status.error));
}

void Mailbox::reached(PlcCommand command, Instant now) {
    if (phase_ == Phase::Stopping) {
        if (command == PlcCommand::Abort) {
            phase_ = Phase::Stopped;
            emit(Event::Kind::Stopped, {}, static_cast<long>(executed_));
        } else {
            order(PlcCommand::Abort, now);
        }
        return;
    }
    if (command == PlcCommand::Start) {
        ours_ = true;
    } else if (command == PlcCommand::Hold) {
        emit(Event::Kind::Paused);
    } else if (command == PlcCommand::Resume) {
        phase_ = Phase::Running;
        emit(Event::Kind::Resumed);
    } else if (command == PlcCommand::ToolChanged) {
        machine_asks_ = false;
    }
}

/// False: what the machine says of its lines does not fit, and something was done about it.
bool Mailbox::follow_count(const PlcStatus& status, Instant now) {
    if (phase_ == Phase::Stopping) {
        return true;
    }
    if (status.job != job_number_ || status.accepted < accepted_) {
        if (failures_ < 2) {
            recover(now);
            return false;
        }
        fail("protocol.lost_count",
             "the machine works on another job, or has lost lines: another "
             "sender, or a restart");
        return false;
    }
    if (meeting_ == Meeting::Again && status.accepted <= job_.size()) {
        // Slots that an earlier process has written may still be taken.
        sent_ = std::max<std::size_t>(sent_, status.accepted);
    }
    if (status.accepted > sent_ || status.executed > status.accepted) {
        fail("protocol.lost_count", "the machine has more lines than were sent");
        return false;
    }
    accepted_ = status.accepted;
    executed_ = std::max<std::size_t>(executed_, status.executed);
    while (!blocks_.empty() && blocks_.front().first + blocks_.front().count <= accepted_) {
        blocks_.pop_front();
    }
    if (next_ < accepted_) {
        // Blocks from before going back were taken after all.
        go_back();
    }
    if (!blocks_.empty() && status.state == PlcState::Run) {
        const Block& oldest = blocks_.front();
        const bool complains = status.error == kGap || status.error == kDamaged;
        const Instant wait =
            complains ? Instant(100ms) : std::max<Instant>(2s, 4 * options_.timeout);
        if (now - oldest.sent_at > wait && status.free_lines >= oldest.count) {
            emit(Event::Kind::Resent, plc_error_text(status.error),
                 static_cast<long>(oldest.first));
            go_back();
        }
    }
    return true;
}

void Mailbox::follow_barrier(const PlcStatus& status) {
    if (!barrier_ || executed_ < *barrier_ || phase_ != Phase::Running) {
        return;
    }
    const std::size_t entry = *barrier_ - 1;
    passed_ = *barrier_;
    barrier_.reset();
    if (const AxisValues* wanted = job_.expected(entry)) {
        for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
            const double is = status.position_mm.at(axis);
            // NaN: nobody knows where it should be.
            if (std::abs(is - wanted->at(axis)) > options_.position_tolerance_mm) {
                fail("protocol.position_differs",
                     std::string("after line ") + std::to_string(job_.source(entry)) +
                         " the machine stands at " + std::to_string(is) + " on axis " +
                         std::string(1, "XYZABC"[axis]) + ", the job wants " +
                         std::to_string(wanted->at(axis)));
                return;
            }
        }
    }
    if (job_.kind(entry) == LineKind::Ask) {
        phase_ = Phase::Asking;
        emit(Event::Kind::Asked, job_.question(entry), static_cast<long>(entry));
    }
}

void Mailbox::follow_state(const PlcStatus& status, Instant /*now*/) {
    if (is_over(phase_) || phase_ == Phase::Stopping || pending_) {
        return;
    }
    switch (status.state) {
        case PlcState::Alarm:
        case PlcState::EmergencyStop:
            fail(status.error == kErrorRestarted ? "protocol.machine_reset" : "protocol.alarm",
                 "the machine is in alarm: " + plc_error_text(status.error));
            break;
        case PlcState::Hold:
            if (phase_ == Phase::Running) {
                phase_ = Phase::Paused;
                emit(Event::Kind::Paused, "by the machine: " + plc_error_text(status.error));
            }
            break;
        case PlcState::Run:
            if (phase_ == Phase::Paused) {
                phase_ = Phase::Running;
                emit(Event::Kind::Resumed, "at the machine");
            }
            break;
        case PlcState::ToolChange:
            if (phase_ == Phase::Running) {
                phase_ = Phase::Asking;
                machine_asks_ = true;
                emit(Event::Kind::Asked, "the machine waits for a change of tool. Done?",
                     static_cast<long>(executed_));
            }
            break;
        case PlcState::Idle:
        case PlcState::Done:
            if (executed_ >= job_.size()) {
                phase_ = Phase::Finished;
                emit(Event::Kind::Finished);
            } else if (status.state == PlcState::Idle) {
                phase_ = Phase::Stopped;
                emit(Event::Kind::Stopped, "at the machine", static_cast<long>(executed_));
            }
            break;
        default:
            break;
    }
}

}  // namespace cam::protocol
