// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/journal/journal.h"
#include "cam/protocol/protocol.h"
#include "cam/stream/raw_log.h"
#include "cam/transport/channel.h"
#include "decomp/base/result.h"

#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace cam::stream {

/// What the one who watches is told.
struct Notice {
    enum class Kind {
        Event,     ///< of the conversation
        LinkLost,  ///< `event.text` says how; the port is looked for until somebody cancels
        LinkBack,
        Told  ///< progress or status has changed
    };

    Kind kind = Kind::Event;
    protocol::Event event;
    protocol::Phase phase = protocol::Phase::Closed;
    protocol::Progress progress;
    protocol::Status status;
    double seconds = 0;  ///< since the session began
};

/// How a session ended.
struct Outcome {
    protocol::Phase phase = protocol::Phase::Failed;  ///< Finished, Stopped or Failed
    std::string code;                                 ///< of a failure
    std::string text;
    protocol::Progress progress;
    double seconds = 0;
};

/// Carries a conversation over a port: reads, writes, keeps the time, writes the journal, finds the
/// port again when it was unplugged. run() is the only thread that touches port and conversation;
/// post() may be called from any thread and wakes it at once.
class Session {
  public:
    using Open = std::function<decomp::Result<std::unique_ptr<transport::ByteChannel>>()>;

    struct Options {
        protocol::Meeting meeting = protocol::Meeting::Fresh;
        bool reconnects = true;        ///< look for the port again when it is gone
        bool asks_to_continue = true;  ///< after a reconnection, and when meeting Again
        std::chrono::milliseconds told_every{500};
        journal::Writer* journal = nullptr;  ///< null: none is kept
        RawLog* log = nullptr;               ///< null: none is kept
        /// May the job run on this machine? Called once, when it has told who it is.
        std::function<decomp::Status(const protocol::Identity&)> admit;
        /// Called by the thread of run().
        std::function<void(const Notice&)> tell;
    };

    /// All must outlive the session.
    Session(protocol::Protocol& conversation, Open open, Options options);
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    Session(Session&&) = delete;
    Session& operator=(Session&&) = delete;
    ~Session();

    /// From now on the journal is kept, and no line leaves that it does not allow. Before run().
    void keep(journal::Writer& journal) { options_.journal = &journal; }

    /// What the operator wants; any thread.
    void post(protocol::Wish wish);

    /// For journal::Writer::Options::on_synced; any thread.
    void wake();

    /// Runs the job to its end. Waits without using the processor.
    /// @error transport.* when the port cannot be opened at first
    [[nodiscard]] decomp::Result<Outcome> run();

  private:
    using Instant = protocol::Instant;

    decomp::Status connect();
    void carry_out(Instant now);
    void handle(const protocol::Event& event, Instant now);
    void ready(const protocol::Event& event, Instant now);
    void push_bytes();
    bool wait(Instant now);
    void read_bytes(Instant now);
    void lose(const decomp::Error& error, Instant now);
    void look_for_port(Instant now);
    void take_wishes(Instant now);
    void keep_journal(Instant now);
    void tell(Notice::Kind kind, protocol::Event event = {});
    void tell_changes(Instant now);
    [[nodiscard]] Instant now() const;

    protocol::Protocol& conversation_;
    Open open_;
    Options options_;
    std::unique_ptr<transport::ByteChannel> channel_;
    int wake_ = -1;
    std::string unsent_;
    std::chrono::steady_clock::time_point start_;
    std::mutex mutex_;
    std::deque<protocol::Wish> wishes_;

    protocol::Meeting meeting_ = protocol::Meeting::Fresh;
    std::optional<std::size_t> waiting_to_run_;  ///< entry to run from, after the operator's yes
    bool admitted_ = false;
    std::optional<Outcome> ended_;
    Instant look_at_{};

    std::size_t asked_for_ = 0;  ///< entries whose permission is on its way to the disk
    std::size_t permitted_ = 0;
    std::deque<std::pair<std::uint64_t, std::size_t>> permissions_;
    std::size_t noted_acked_ = 0;
    std::size_t noted_sent_ = 0;
    std::size_t last_block_ = 64;
    Instant block_since_{};
    bool journal_failed_ = false;

    Instant told_at_{};
    long told_version_ = -1;
    std::size_t told_acked_ = 0;
};

}  // namespace cam::stream
