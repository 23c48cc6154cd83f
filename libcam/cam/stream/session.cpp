// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/session.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>

namespace cam::stream {

using namespace std::chrono_literals;
using protocol::Event;
using protocol::Phase;

namespace {

constexpr std::chrono::nanoseconds kLookEvery = 250ms;
constexpr std::size_t kReadBytes = 4096;

}  // namespace

Session::Session(protocol::Protocol& conversation, Open open, Options options)
    : conversation_(conversation),
      open_(std::move(open)),
      options_(std::move(options)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      start_(std::chrono::steady_clock::now()) {}

Session::~Session() { ::close(wake_); }

Session::Instant Session::now() const { return std::chrono::steady_clock::now() - start_; }

void Session::wake() {
    const std::uint64_t one = 1;
    (void)!::write(wake_, &one, sizeof one);
}

void Session::post(protocol::Wish wish) {
    {
        const std::scoped_lock lock(mutex_);
        wishes_.push_back(wish);
    }
    wake();
}

decomp::Status Session::connect() {
    auto opened = open_();
    if (!opened) {
        return decomp::fail(opened.error());
    }
    channel_ = std::move(*opened);
    unsent_.clear();
    conversation_.meet(meeting_, now());
    return {};
}

decomp::Result<Outcome> Session::run() {
    meeting_ = options_.meeting;
    if (const decomp::Status connected = connect(); !connected) {
        return decomp::fail(connected.error());
    }
    if (options_.journal == nullptr) {
        conversation_.allow(conversation_.progress().total, now());
    }
    while (!ended_) {
        const Instant at = now();
        carry_out(at);
        keep_journal(at);
        tell_changes(at);
        if (ended_) {
            break;
        }
        const bool readable = wait(at);
        const Instant then = now();
        take_wishes(then);
        if (readable) {
            read_bytes(then);
        }
        if (channel_ == nullptr && then >= look_at_) {
            look_for_port(then);
        }
        if (const auto deadline = conversation_.deadline(); deadline && then >= *deadline) {
            conversation_.tick(then);
        }
    }
    carry_out(now());
    push_bytes();
    ended_->progress = conversation_.progress();
    ended_->seconds = std::chrono::duration<double>(now()).count();
    if (options_.journal != nullptr) {
        if (ended_->progress.sent > 0) {
            options_.journal->add("at " + std::to_string(ended_->progress.acked) + " " +
                                  std::to_string(ended_->progress.sent));
        }
        options_.journal->add(
            "end " + std::string(protocol::phase_name(ended_->phase)) + " " + ended_->code,
            journal::Writer::Urgency::Urgent);
    }
    return *ended_;
}

/// Does what the conversation asks for.
void Session::carry_out(Instant now) {
    while (true) {
        protocol::Output out = conversation_.take_output();
        if (out.empty()) {
            break;
        }
        if (out.discard) {
            unsent_.clear();
            if (channel_ != nullptr) {
                channel_->discard_output();
            }
        }
        unsent_.insert(0, out.urgent);
        unsent_ += out.bytes;
        push_bytes();
        for (const Event& event : out.events) {
            handle(event, now);
        }
    }
}

void Session::push_bytes() {
    if (channel_ == nullptr || unsent_.empty()) {
        return;
    }
    const auto sent = channel_->write(unsent_);
    if (!sent) {
        lose(sent.error(), now());
        return;
    }
    if (options_.log != nullptr && *sent > 0) {
        options_.log->sent(std::string_view(unsent_).substr(0, *sent), now());
    }
    unsent_.erase(0, *sent);
}

void Session::handle(const Event& event, Instant now) {
    if (options_.journal != nullptr && event.kind != Event::Kind::Resent) {
        std::string text = "event " + std::to_string(static_cast<int>(event.kind)) + " " +
                           std::to_string(event.line) + " " + event.code + " " + event.text;
        std::replace(text.begin(), text.end(), '\n', ' ');
        options_.journal->add(text);
    }
    const Event::Kind kind = event.kind;
    if (kind == Event::Kind::Finished || kind == Event::Kind::Stopped ||
        kind == Event::Kind::Failed) {
        if (!ended_) {
            ended_ = Outcome{conversation_.phase(), event.code, event.text, {}, 0};
        }
    }
    tell(Notice::Kind::Event, event);
    if (kind == Event::Kind::Ready) {
        ready(event, now);
    }
}

/// The machine is known: may the job run, and from where?
void Session::ready(const Event& event, Instant now) {
    if (!admitted_ && options_.admit) {
        if (const decomp::Status admitted = options_.admit(conversation_.identity()); !admitted) {
            const decomp::Error& error = admitted.error();
            std::string text = error.where.empty() ? "" : error.where + ": ";
            text += error.message + (error.hint.empty() ? "" : "; " + error.hint);
            ended_ = Outcome{Phase::Failed, error.code, text, {}, 0};
            return;
        }
    }
    admitted_ = true;
    const auto first = static_cast<std::size_t>(std::max(event.line, 0L));
    if (meeting_ == protocol::Meeting::Again && options_.asks_to_continue) {
        waiting_to_run_ = first;
        Event asked;
        asked.kind = Event::Kind::Asked;
        asked.text = "the machine has " + std::to_string(first) + " of " +
                     std::to_string(conversation_.progress().total) +
                     " lines and was not reset. Continue?";
        asked.line = event.line;
        tell(Notice::Kind::Event, asked);
        return;
    }
    conversation_.run(first, now);
}

/// Sleeps until something is to be done. True when the port has something to say.
bool Session::wait(Instant now) {
    Instant until = now + 1h;
    if (const auto deadline = conversation_.deadline()) {
        until = std::min(until, *deadline);
    }
    if (channel_ == nullptr) {
        until = std::min(until, look_at_);
    }
    if (conversation_.status().version != told_version_ ||
        conversation_.progress().acked != told_acked_) {
        until = std::min(until, told_at_ + Instant(options_.told_every));
    }
    const Instant left = std::max(until - now, Instant(0));
    const timespec time{static_cast<std::time_t>(left / 1s), (left % Instant(1s)).count()};
    std::array<pollfd, 2> watched{
        pollfd{wake_, POLLIN, 0},
        pollfd{channel_ != nullptr ? channel_->descriptor() : -1,
               static_cast<short>(unsent_.empty() ? POLLIN : POLLIN | POLLOUT), 0}};
    ::ppoll(watched.data(), watched.size(), &time, nullptr);
    if ((watched[0].revents & POLLIN) != 0) {
        std::uint64_t count = 0;
        (void)!::read(wake_, &count, sizeof count);
    }
    if ((watched[1].revents & POLLOUT) != 0) {
        push_bytes();
    }
    return (watched[1].revents & (POLLIN | POLLHUP | POLLERR | POLLNVAL)) != 0;
}

void Session::read_bytes(Instant now) {
    if (channel_ == nullptr) {
        return;
    }
    std::array<char, kReadBytes> bytes{};
    const auto got = channel_->read(bytes.data(), bytes.size());
    if (!got) {
        lose(got.error(), now);
        return;
    }
    if (*got > 0) {
        const std::string_view text(bytes.data(), *got);
        if (options_.log != nullptr) {
            options_.log->received(text, now);
        }
        conversation_.receive(text, now);
    }
}

void Session::lose(const decomp::Error& error, Instant now) {
    if (channel_ == nullptr) {
        return;
    }
    channel_.reset();
    unsent_.clear();
    waiting_to_run_.reset();
    const bool had_begun = admitted_ && !protocol::is_over(conversation_.phase());
    conversation_.lose_link(now);
    Event event;
    event.text = error.text();
    tell(Notice::Kind::LinkLost, event);
    if (options_.journal != nullptr) {
        options_.journal->add("lost");
    }
    if (!protocol::is_over(conversation_.phase()) && (!options_.reconnects || !had_begun)) {
        ended_ = Outcome{Phase::Failed, error.code, error.text(), {}, 0};
    }
    look_at_ = now + kLookEvery;
}

void Session::look_for_port(Instant now) {
    look_at_ = now + kLookEvery;
    meeting_ = protocol::Meeting::Again;
    if (connect()) {
        tell(Notice::Kind::LinkBack);
    }
}

void Session::take_wishes(Instant now) {
    std::deque<protocol::Wish> wishes;
    {
        const std::scoped_lock lock(mutex_);
        wishes.swap(wishes_);
    }
    for (const protocol::Wish wish : wishes) {
        const bool ends = wish == protocol::Wish::Cancel || wish == protocol::Wish::Stop;
        if (channel_ == nullptr && ends) {
            ended_ =
                Outcome{Phase::Stopped, {}, "the port is gone; the machine was not told", {}, 0};
        } else if (waiting_to_run_ && wish == protocol::Wish::Resume) {
            const std::size_t first = *waiting_to_run_;
            waiting_to_run_.reset();
            conversation_.run(first, now);
        } else {
            conversation_.wish(wish, now);
        }
    }
}

/// Before a line may leave, the disk holds that it may: after any end it is known how far the
/// machine can be at most.
void Session::keep_journal(Instant now) {
    if (options_.journal == nullptr) {
        return;
    }
    const protocol::Progress progress = conversation_.progress();
    if (progress.acked != noted_acked_ || progress.sent != noted_sent_) {
        options_.journal->note(
            "at " + std::to_string(progress.acked) + " " + std::to_string(progress.sent),
            progress.acked > noted_acked_ ? progress.acked - noted_acked_ : 0);
        noted_acked_ = progress.acked;
        noted_sent_ = progress.sent;
    }
    constexpr std::size_t kBlock = 64;
    constexpr std::size_t kMostBlock = 65536;
    const std::size_t ahead = asked_for_ > progress.sent ? asked_for_ - progress.sent : 0;
    if (permissions_.empty() && asked_for_ < progress.total && ahead <= last_block_ / 2) {
        // The disk must keep up: the faster the last block was used, the larger the next.
        const bool fast = now - block_since_ < 500ms;
        last_block_ = std::clamp(fast ? 2 * last_block_ : last_block_ / 2, kBlock, kMostBlock);
        block_since_ = now;
        asked_for_ = std::min(std::max(asked_for_, progress.sent) + last_block_, progress.total);
        permissions_.emplace_back(options_.journal->add("allow " + std::to_string(asked_for_),
                                                        journal::Writer::Urgency::Urgent),
                                  asked_for_);
    }
    const std::uint64_t durable = options_.journal->durable();
    while (!permissions_.empty() && permissions_.front().first < durable) {
        permitted_ = permissions_.front().second;
        permissions_.pop_front();
        conversation_.allow(permitted_, now);
        carry_out(now);
    }
    if (!journal_failed_) {
        if (const decomp::Status status = options_.journal->status(); !status) {
            journal_failed_ = true;
            conversation_.wish(protocol::Wish::Pause, now);
            Event event;
            event.kind = Event::Kind::Warning;
            event.code = status.error().code;
            event.text = status.error().text() + "; the job is held";
            tell(Notice::Kind::Event, event);
        }
    }
}

void Session::tell(Notice::Kind kind, Event event) {
    if (!options_.tell) {
        return;
    }
    Notice notice;
    notice.kind = kind;
    notice.event = std::move(event);
    notice.phase = conversation_.phase();
    notice.progress = conversation_.progress();
    notice.status = conversation_.status();
    notice.seconds = std::chrono::duration<double>(now()).count();
    options_.tell(notice);
}

void Session::tell_changes(Instant now) {
    const std::size_t acked = conversation_.progress().acked;
    const long version = conversation_.status().version;
    if ((acked == told_acked_ && version == told_version_) ||
        now < told_at_ + Instant(options_.told_every)) {
        return;
    }
    told_at_ = now;
    told_acked_ = acked;
    told_version_ = version;
    tell(Notice::Kind::Told);
}

}  // namespace cam::stream
