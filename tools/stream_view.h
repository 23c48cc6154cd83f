// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/stream/stream_program.h"

#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>

namespace tools {

/// A running job on the terminal: what it says, a line of figures, keys. tell() may be called by
/// any thread and never waits for the terminal; watch() runs on the caller's.
class StreamView {
  public:
    struct Options {
        bool yes = false;  ///< answer every question with yes
        bool quiet = false;
        bool json = false;  ///< events on stderr, one JSON object a line, for people none
        std::filesystem::path events;  ///< one JSON object a line; empty: none
    };

    StreamView(cam::stream::ProgramStream& stream, Options options);
    StreamView(const StreamView&) = delete;
    StreamView& operator=(const StreamView&) = delete;
    StreamView(StreamView&&) = delete;
    StreamView& operator=(StreamView&&) = delete;
    ~StreamView();

    void tell(const cam::stream::Notice& notice);

    /// The job has ended: watch() returns once everything is told.
    void end();

    /// Shows the job and reads keys until end(). A stop request cancels the job.
    void watch(const std::stop_token& stop);

  private:
    void wake() const;
    void show(const cam::stream::Notice& notice);
    void ask(const cam::protocol::Event& event);
    void read_keys();
    void say(const std::string& text);
    void status_line(const cam::stream::Notice& notice);
    void key(char c);
    void write_event(const cam::stream::Notice& notice);
    void post(cam::protocol::Wish wish);

    cam::stream::ProgramStream& stream_;
    Options options_;
    std::FILE* events_ = nullptr;
    int wake_ = -1;
    bool terminal_ = false;
    bool drawn_ = false;
    bool asked_ = false;
    bool reads_keys_ = true;
    std::size_t choices_ = 0;  ///< of the open question, beyond yes and no
    std::mutex mutex_;
    std::deque<cam::stream::Notice> notices_;
    bool ended_ = false;
};

}  // namespace tools
