// SPDX-License-Identifier: GPL-3.0-or-later
// What travels beside the lines of the job: the operator's feed, temperatures that are asked for,
// stops, answers to the machine's questions.
#include "cam/protocol/marlin.h"

#include <algorithm>
#include <cmath>

namespace cam::protocol {

using namespace std::chrono_literals;

namespace {

constexpr Instant kKillWait = 2s;
constexpr double kFeedStep = 10;
constexpr double kLeastFeed = 10;
constexpr double kMostFeed = 200;
constexpr int kFeedTries = 3;
constexpr std::size_t kMostChoices = 9;
constexpr std::size_t kLongestPrompt = 400;
constexpr double kToldToMm = 0.02;  ///< M114 tells hundredths of single precision

/// What follows "prompt_button " and the like.
std::string rest_of(std::string_view action) {
    const std::size_t space = std::min(action.find(' '), action.size());
    return std::string(action.substr(std::min(space + 1, action.size())));
}

}  // namespace

bool Marlin::may_talk_aside() const {
    return !killed_ &&
           (phase_ == Phase::Running || phase_ == Phase::Paused || phase_ == Phase::Asking);
}

bool Marlin::may_send_aside() const {
    return may_talk_aside() && !asides_.empty() && aside_.empty() && acked_ == next_ &&
           !hold_until_ && !query_pending_;
}

void Marlin::add_aside(std::string text, Instant now) {
    if (std::find(asides_.begin(), asides_.end(), text) == asides_.end()) {
        asides_.push_back(std::move(text));
    }
    fill(now);
}

void Marlin::send_aside(Instant now) {
    aside_ = std::move(asides_.front());
    asides_.pop_front();
    out_.bytes += aside_ + "\n";
    last_send_ = now;
}

/// A line without a number has no checksum either: what it brought about is read back.
void Marlin::aside_answered() {
    const std::string done = std::move(aside_);
    aside_.clear();
    const double told = std::round(status_.feed_override * 100);
    if (done != "M220") {
        return;
    }
    if (told == feed_percent_) {
        emit(Event::Kind::Notice, "feed " + std::to_string(static_cast<int>(told)) + " %");
    } else if (++feed_tries_ < kFeedTries) {
        asides_.push_back("M220 S" + std::to_string(static_cast<int>(feed_percent_)));
        asides_.emplace_back("M220");
    } else {
        emit(Event::Kind::Warning, "the machine does not tell that its feed is " +
                                       std::to_string(static_cast<int>(feed_percent_)) +
                                       " %: look at its display");
    }
}

void Marlin::change_feed(Wish wish, Instant now) {
    if (!may_talk_aside()) {
        return;
    }
    // From what is asked for and not yet told, so that three presses are three steps.
    const bool under_way = aside_.starts_with("M220") || !asides_.empty();
    const double from = under_way ? feed_percent_ : std::round(status_.feed_override * 100);
    const double step = wish == Wish::FeedUp ? kFeedStep : -kFeedStep;
    feed_percent_ = wish == Wish::FeedReset ? 100 : std::clamp(from + step, kLeastFeed, kMostFeed);
    feed_tries_ = 0;
    std::erase_if(asides_, [](const std::string& text) { return text.starts_with("M220"); });
    asides_.push_back("M220 S" + std::to_string(static_cast<int>(feed_percent_)));
    add_aside("M220", now);
}

void Marlin::stop(Instant now) {
    out_.discard = true;
    out_.bytes.clear();
    out_.urgent = "\nM112\n";
    phase_ = Phase::Stopping;
    killed_ = true;
    cut_ = next_;
    tail_.clear();
    asides_.clear();
    aside_.clear();
    hold_until_.reset();
    stop_until_ = now + kKillWait;
    if (!identity_.emergency_parser) {
        emit(Event::Kind::Warning,
             "this firmware has no emergency parser: the stop waits behind the lines that it has "
             "already taken. Use the machine's own switch");
    }
}

void Marlin::choose(int index, Instant /*now*/) {
    if (!prompted_ || index < 0 ||
        index >= static_cast<int>(std::max<std::size_t>(choices_.size(), 1))) {
        return;
    }
    prompted_ = false;
    prompt_.clear();
    choices_.clear();
    out_.urgent += "\nM876 S" + std::to_string(index) + "\n";
}

void Marlin::on_action(std::string_view action, Instant now) {
    if (action == "pause" || action == "paused") {
        pause("by the machine");
    } else if ((action == "resume" || action == "resumed") && phase_ == Phase::Paused) {
        resume(now);
    } else if (action == "cancel") {
        cancel(now);
    } else if (action.starts_with("prompt_begin")) {
        prompt_ = rest_of(action).substr(0, kLongestPrompt);
        choices_.clear();
    } else if (action.starts_with("prompt_button") || action.starts_with("prompt_choice")) {
        if (choices_.size() < kMostChoices) {
            choices_.push_back(rest_of(action).substr(0, kLongestPrompt));
        }
    } else if (action == "prompt_show") {
        prompted_ = true;
        emit(Event::Kind::Asked, prompt_);
        out_.events.back().choices = choices_;
    } else if (action == "prompt_end") {
        prompted_ = false;
        prompt_.clear();
        choices_.clear();
    } else {
        emit(Event::Kind::Warning, "the machine reports: " + std::string(action));
    }
}

/// The job has ended, so nothing can be stopped any more; what was made must be looked at.
void Marlin::compare_position(std::size_t entry) {
    if (!job_.text(entry).starts_with("M114")) {
        return;
    }
    if (!position_told_) {
        emit(Event::Kind::Warning, "the machine did not tell where it stands: not compared");
        return;
    }
    const AxisValues& expected = *job_.expected(entry);
    const double tolerance = std::max(options_.position_tolerance_mm, kToldToMm);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double off = std::abs(expected.at(axis) - status_.position_mm.at(axis));
        if (off > tolerance) {
            emit(Event::Kind::Warning,
                 "the machine stands " + std::to_string(off) + " mm from where the job ends on " +
                     std::string(1, "XYZ"[axis]) +
                     ": a line was changed on its way, or the firmware moved by itself",
                 static_cast<long>(entry));
            out_.events.back().code = "protocol.position_differs";
        }
    }
}

}  // namespace cam::protocol
