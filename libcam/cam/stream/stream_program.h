// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/link.h"
#include "cam/stream/gate.h"
#include "cam/stream/prepare.h"
#include "cam/stream/resume.h"
#include "cam/stream/session.h"
#include "decomp/base/result.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace cam::stream {

/// What is to be streamed, and what the operator has decided beforehand.
struct Request {
    std::filesystem::path program;
    std::string machine;         ///< name of the profile
    std::string profile_sha256;  ///< of the set-up that the program was proved for
    Limits limits;               ///< of the machine
    profile::Link link;
    std::string port;      ///< as for transport::open_channel
    bool foreign = false;  ///< no proof is asked for: bounds alone are looked at
    Allowances allowed;
    bool resume = false;             ///< go on where the journal says
    bool after_reset = false;        ///< … and the machine was reset: it is homed and idle again
    std::optional<long> from_line;   ///< … from this line of the program on
    bool looks = true;               ///< … the machine may be asked where it stands
    bool force = false;              ///< an older journal is thrown away
    std::filesystem::path journal;   ///< empty: PROGRAM.journal
    std::filesystem::path log;       ///< raw log; empty: none
    std::vector<std::string> notes;  ///< decisions that the journal keeps, e.g. "--yes"
};

/// A job that may begin: gate passed, lines made, journal open.
class ProgramStream {
  public:
    /// Reads program, proof and journal, and judges them. The port is touched only to ask a mill
    /// where it stands, when a job of it is to go on.
    /// @error file.*, proof.* (no valid sidecar), stream.*, and stream.journal_exists (a job was
    /// begun and neither resumed nor forced), stream.journal_differs (of another program)
    [[nodiscard]] static decomp::Result<std::unique_ptr<ProgramStream>> open(Request request);

    ProgramStream(const ProgramStream&) = delete;
    ProgramStream& operator=(const ProgramStream&) = delete;
    ProgramStream(ProgramStream&&) = delete;
    ProgramStream& operator=(ProgramStream&&) = delete;
    ~ProgramStream();

    /// What will happen, for people: one fact a line.
    [[nodiscard]] const std::string& summary() const { return summary_; }

    [[nodiscard]] const WireJob& job() const { return job_; }

    /// Whether the job goes on, rather than begins.
    [[nodiscard]] bool resumes() const { return request_.resume; }

    /// Streams the job; the calling thread carries port and conversation until the end.
    /// @error transport.*, file.unwritable
    [[nodiscard]] decomp::Result<Outcome> run(const std::function<void(const Notice&)>& tell);

    /// What the operator wants; any thread.
    void post(protocol::Wish wish);

  private:
    explicit ProgramStream(Request request);
    decomp::Status read_program();
    decomp::Status check_gate();
    decomp::Status make_lines();
    decomp::Status resume_lines(const Standing& standing);
    decomp::Status resume_after_reset(const Standing& standing, const WireJob& old);
    decomp::Result<std::optional<long>> line_where_it_stands(long first, long last);
    decomp::Status open_journal();
    void make_session(const std::function<void(const Notice&)>& tell);
    [[nodiscard]] Session::Open opener() const;
    decomp::Status sum_up();
    [[nodiscard]] decomp::Status admit(const protocol::Identity& identity) const;
    [[nodiscard]] protocol::LinkOptions link_options() const;
    [[nodiscard]] WireOptions wire_options() const;

    decomp::Status make_conversation();

    [[nodiscard]] bool is_modbus() const { return request_.link.line.protocol == "modbus"; }

    [[nodiscard]] bool is_mill() const { return request_.limits.flavour == Flavour::Mill; }

    Request request_;
    std::string program_;
    std::string summary_;
    WireJob job_;
    JournalHead head_;
    bool same_board_ = false;  ///< resumes on a board that was not reset
    std::unique_ptr<journal::Writer> journal_;
    std::unique_ptr<RawLog> log_;
    std::unique_ptr<protocol::Protocol> conversation_;
    std::mutex mutex_;                   ///< of the two below
    std::vector<protocol::Wish> early_;  ///< wishes from before there was a session
    std::unique_ptr<Session> session_;
};

}  // namespace cam::stream
