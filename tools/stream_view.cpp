// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/stream_view.h"

#include "decomp/base/number.h"
#include "tools/values.h"
#include "tools/verb.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace tools {

using cam::protocol::Event;
using cam::protocol::Wish;
using cam::stream::Notice;

namespace {

constexpr std::size_t kMostNotices = 10000;

/// Keys one by one, without echo, for as long as it lives.
class KeyMode {
  public:
    KeyMode() {
        if (::isatty(STDIN_FILENO) != 0 && ::tcgetattr(STDIN_FILENO, &before_) == 0) {
            termios keys = before_;
            keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
            changed_ = ::tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0;
        }
    }

    KeyMode(const KeyMode&) = delete;
    KeyMode& operator=(const KeyMode&) = delete;
    KeyMode(KeyMode&&) = delete;
    KeyMode& operator=(KeyMode&&) = delete;

    ~KeyMode() {
        if (changed_) {
            ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
        }
    }

  private:
    termios before_{};
    bool changed_ = false;
};

/// A figure of the machine; whatever it says, the job goes on.
std::string figure(double value, int decimals) {
    constexpr double kMost = 1e8;
    return std::abs(value) < kMost ? decomp::fixed(value, decimals) : std::string("?");
}

const char* kind_name(const Notice& notice) {
    if (notice.kind == Notice::Kind::LinkLost) {
        return "link_lost";
    }
    if (notice.kind == Notice::Kind::LinkBack) {
        return "link_back";
    }
    if (notice.kind == Notice::Kind::Told) {
        return "status";
    }
    constexpr std::array<const char*, 12> kNames = {"identified", "ready",    "checked", "paused",
                                                    "resumed",    "asked",    "resent",  "notice",
                                                    "warning",    "finished", "stopped", "failed"};
    return kNames.at(static_cast<std::size_t>(notice.event.kind));
}

}  // namespace

StreamView::StreamView(cam::stream::ProgramStream& stream, Options options)
    : stream_(stream),
      options_(std::move(options)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      terminal_(::isatty(STDERR_FILENO) != 0) {
    if (!options_.events.empty()) {
        events_ = std::fopen(options_.events.c_str(), "we");
    }
}

StreamView::~StreamView() {
    if (events_ != nullptr) {
        std::fclose(events_);
    }
    ::close(wake_);
}

void StreamView::wake() const {
    const std::uint64_t one = 1;
    (void)!::write(wake_, &one, sizeof one);
}

void StreamView::tell(const Notice& notice) {
    {
        const std::scoped_lock lock(mutex_);
        // A terminal that is stopped must not fill the memory: figures may be left out.
        if (notices_.size() < kMostNotices || notice.kind != Notice::Kind::Told) {
            notices_.push_back(notice);
        }
    }
    wake();
}

void StreamView::end() {
    {
        const std::scoped_lock lock(mutex_);
        ended_ = true;
    }
    wake();
}

void StreamView::post(Wish wish) { stream_.post(wish); }

void StreamView::watch(const std::stop_token& stop) {
    const KeyMode keys;
    const std::stop_callback cancelled(stop, [this] {
        post(Wish::Cancel);
        wake();
    });
    while (true) {
        std::deque<Notice> notices;
        bool ended = false;
        {
            const std::scoped_lock lock(mutex_);
            notices.swap(notices_);
            ended = ended_;
        }
        for (const Notice& notice : notices) {
            show(notice);
        }
        if (ended) {
            say({});
            return;
        }
        std::array<pollfd, 2> watched{pollfd{wake_, POLLIN, 0},
                                      pollfd{reads_keys_ ? STDIN_FILENO : -1, POLLIN, 0}};
        ::poll(watched.data(), watched.size(), -1);
        if ((watched[0].revents & POLLIN) != 0) {
            std::uint64_t count = 0;
            (void)!::read(wake_, &count, sizeof count);
        }
        if (watched[1].revents != 0) {
            read_keys();
        }
        if (asked_ && !reads_keys_) {
            asked_ = false;
            say("nobody is there to answer: the job is cancelled (--yes answers with yes)");
            post(Wish::Cancel);
        }
    }
}

void StreamView::read_keys() {
    std::array<char, 64> typed{};
    const ssize_t got = ::read(STDIN_FILENO, typed.data(), typed.size());
    reads_keys_ = got > 0;
    for (ssize_t i = 0; i < got; ++i) {
        key(typed.at(static_cast<std::size_t>(i)));
    }
}

void StreamView::key(char c) {
    switch (c) {
        case 'p':
            post(Wish::Pause);
            break;
        case 'r':
        case 'y':
            asked_ = false;
            post(Wish::Resume);
            break;
        case 'n':
            if (asked_ && choices_ == 0) {
                post(Wish::Cancel);
            }
            break;
        case 'c':
            post(Wish::Cancel);
            break;
        case 's':
            post(Wish::Stop);
            break;
        case '+':
            post(Wish::FeedUp);
            break;
        case '-':
            post(Wish::FeedDown);
            break;
        case '=':
            post(Wish::FeedReset);
            break;
        default:
            if (c > '0' && static_cast<std::size_t>(c - '0') <= choices_) {
                asked_ = false;
                choices_ = 0;
                post(cam::protocol::choice(c - '1'));
            }
            break;
    }
}

void StreamView::say(const std::string& text) {
    if (drawn_) {
        std::fputs("\r\x1b[K", stderr);
        drawn_ = false;
    }
    if (!text.empty() && !options_.quiet && !options_.json) {
        std::fprintf(stderr, "%s\n", text.c_str());
    }
    std::fflush(stderr);
}

void StreamView::show(const Notice& notice) {
    write_event(notice);
    const Event& event = notice.event;
    if (notice.kind == Notice::Kind::Told) {
        status_line(notice);
        return;
    }
    if (notice.kind == Notice::Kind::LinkLost) {
        say("link lost: " + event.text + "\n  waiting for it to come back (c cancels)");
        return;
    }
    if (notice.kind == Notice::Kind::LinkBack) {
        say("the port is back");
        return;
    }
    switch (event.kind) {
        case Event::Kind::Asked:
            ask(event);
            break;
        case Event::Kind::Resent:
            break;
        case Event::Kind::Ready:
            say("keys: p pause, r resume, c cancel, s stop at once, + - = feed; this is no "
                "emergency "
                "stop");
            break;
        case Event::Kind::Checked:
            say("the controller's check mode found no fault");
            break;
        case Event::Kind::Paused:
            say("paused: " + event.text);
            break;
        case Event::Kind::Resumed:
            say("resumed");
            break;
        case Event::Kind::Warning:
            say("warning: " + event.text);
            break;
        case Event::Kind::Notice:
            say(event.text);
            break;
        case Event::Kind::Identified:
        case Event::Kind::Finished:
        case Event::Kind::Stopped:
        case Event::Kind::Failed:
            break;
    }
}

/// Among several choices none is the yes: those are for a person, here or at the machine.
void StreamView::ask(const Event& event) {
    if (event.choices.size() > 1) {
        std::string text = "? " + event.text + ":";
        for (std::size_t i = 0; i < event.choices.size(); ++i) {
            text += "  [" + std::to_string(i + 1) + "] " + event.choices[i];
        }
        choices_ = event.choices.size();
        say(text + (options_.yes ? "  (--yes does not choose; the machine waits)" : ""));
        return;
    }
    choices_ = 0;
    asked_ = !options_.yes;
    say("? " + event.text + (options_.yes ? " yes (--yes)" : " [y/n]"));
    if (options_.yes) {
        post(Wish::Resume);
    }
}

void StreamView::status_line(const Notice& notice) {
    const auto& progress = notice.progress;
    const double done = stream_.job().seconds_until(progress.acked);
    const double whole = std::max(stream_.job().total_seconds, 0.001);
    const double fraction = progress.total > 0 ? static_cast<double>(progress.acked) /
                                                     static_cast<double>(progress.total)
                                               : 0;
    std::string text = decomp::fixed(100 * fraction, 1) + "% " + std::to_string(progress.acked) +
                       "/" + std::to_string(progress.total);
    if (done > 5 && notice.seconds > 5) {
        text +=
            ", " + duration_text(std::max(0.0, (whole - done) * notice.seconds / done)) + " left";
    }
    if (!notice.status.state.empty()) {
        text += ", " + notice.status.state;
    }
    for (int axis = 0; axis < notice.status.axes; ++axis) {
        const double value = notice.status.position_mm.at(static_cast<std::size_t>(axis));
        text += std::string(" ") + "XYZABC"[axis] + figure(value, 2);
    }
    for (const cam::protocol::Heater& heater : notice.status.heaters) {
        text += " " + heater.name + ":" + figure(heater.celsius, 0) + "/" +
                figure(heater.target_celsius, 0);
    }
    if (notice.status.feed_override != 1) {
        text += " feed " + figure(100 * notice.status.feed_override, 0) + "%";
    }
    if (progress.resent > 0) {
        text += " resent " + std::to_string(progress.resent);
    }
    if (terminal_ && !options_.quiet && !options_.json) {
        std::fprintf(stderr, "\r\x1b[K%s", text.c_str());
        std::fflush(stderr);
        drawn_ = true;
    }
}

void StreamView::write_event(const Notice& notice) {
    if (events_ == nullptr && !options_.json) {
        return;
    }
    Json json{{"event", kind_name(notice)},
              {"seconds", std::round(notice.seconds * 1000) / 1000},
              {"phase", cam::protocol::phase_name(notice.phase)},
              {"acked", notice.progress.acked},
              {"total", notice.progress.total}};
    if (!notice.event.text.empty()) {
        json["text"] = notice.event.text;
    }
    if (!notice.event.code.empty()) {
        json["code"] = notice.event.code;
    }
    if (!notice.event.choices.empty()) {
        json["choices"] = notice.event.choices;
    }
    if (notice.kind == Notice::Kind::Told) {
        json["state"] = notice.status.state;
        json["position_mm"] = Json::array();
        for (int axis = 0; axis < notice.status.axes; ++axis) {
            json["position_mm"].push_back(
                notice.status.position_mm.at(static_cast<std::size_t>(axis)));
        }
        for (const cam::protocol::Heater& heater : notice.status.heaters) {
            json["celsius"][heater.name] = heater.celsius;
        }
        json["feed_override"] = notice.status.feed_override;
    }
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    for (std::FILE* out : {events_, options_.json ? stderr : nullptr}) {
        if (out != nullptr) {
            std::fwrite(text.data(), 1, text.size(), out);
            std::fflush(out);
        }
    }
}

}  // namespace tools
