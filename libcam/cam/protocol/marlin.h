// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/line_splitter.h"
#include "cam/protocol/marlin_reply.h"
#include "cam/protocol/protocol.h"

#include <deque>
#include <string>
#include <vector>

namespace cam::protocol {

/// The conversation with Marlin: numbered lines with a checksum, one in flight unless the board
/// tells line numbers with its answers (ADVANCED_OK), go-back-N when it asks for a line again.
///
/// Entry i of the job always travels as line kFirstNumber + i: whatever happens, also to this
/// process, the number of the last line that the board has tells exactly how far the job is. It is
/// asked for with the query "N9999 M105": no board ever expects that number, so each refuses it and
/// names its last line; one that was reset names 0. Nothing else is ever sent on a guess. All
/// numbers are high, so that a flipped first letter (N to G, M or T) makes no known command of
/// them.
class Marlin final : public Protocol {
  public:
    static constexpr long kFirstNumber = 10001;
    static constexpr long kMeetingNumber = 9990;  ///< of the first line that is ever sent
    static constexpr long kQueryNumber = 9999;    ///< of a line that no board expects

    /// `job` must outlive this.
    Marlin(const JobLines& job, LinkOptions options);

    void meet(Meeting meeting, Instant now) override;
    void lose_link(Instant now) override;
    void run(std::size_t first, Instant now) override;
    void receive(std::string_view bytes, Instant now) override;
    void wish(Wish wish, Instant now) override;
    void allow(std::size_t entries, Instant now) override;
    void tick(Instant now) override;
    [[nodiscard]] std::optional<Instant> deadline() const override;
    [[nodiscard]] Output take_output() override;

    [[nodiscard]] Phase phase() const override { return phase_; }

    [[nodiscard]] Progress progress() const override;

    [[nodiscard]] const Identity& identity() const override { return identity_; }

    [[nodiscard]] const Status& status() const override { return status_; }

  private:
    /// How far meeting the board is.
    enum class Step { Banner, Clear, Name, Autoreport, ReportPlace, Number, Confirm };

    void reply(std::string_view line, Instant now);
    void on_ok(const MarlinReply& reply, Instant now);
    void on_resend(const MarlinReply& reply, Instant now);
    void on_banner(Instant now);
    void on_action(std::string_view action, Instant now);
    void take_report(const MarlinReply& reply);
    void acknowledge(std::size_t entries, Instant now);
    void go_back(std::size_t entries, Instant now);
    void enter(Step step, Instant now);
    [[nodiscard]] Step first_step() const;
    void next_step(Instant now);
    void say_step(Instant now);
    void meeting_reply(const MarlinReply& reply, Instant now);
    void confirmed(long next_number, Instant now);
    void query(Instant now);
    void fill(Instant now);
    void send_entry(Instant now);
    void check_end(Instant now);
    void count_resend(Instant now);
    void cancel(Instant now);
    void stop(Instant now);
    void change_feed(Wish wish, Instant now);
    void add_aside(std::string text, Instant now);
    void send_aside(Instant now);
    void aside_answered();
    [[nodiscard]] bool may_talk_aside() const;
    [[nodiscard]] bool may_send_aside() const;
    [[nodiscard]] bool waits_for_answer() const;
    void choose(int index, Instant now);
    void compare_position(std::size_t entry);
    void pause(const std::string& why);
    void resume(Instant now);
    void silence(Instant now);
    void fail(std::string code, std::string text);
    void emit(Event::Kind kind, std::string text = {}, long line = 0);
    [[nodiscard]] std::string_view text(std::size_t entry) const;
    [[nodiscard]] LineKind kind(std::size_t entry) const;

    [[nodiscard]] std::size_t end() const { return cut_ + tail_.size(); }

    [[nodiscard]] bool may_send() const;

    const JobLines& job_;
    LinkOptions options_;
    Phase phase_ = Phase::Closed;
    Output out_;
    Identity identity_;
    Status status_;
    LineSplitter splitter_;

    Meeting meeting_ = Meeting::Fresh;
    Step step_ = Step::Banner;
    int step_tries_ = 0;
    bool step_refused_ = false;
    Instant step_until_{};

    std::size_t acked_ = 0;  ///< entries that are answered for
    std::size_t next_ = 0;   ///< entry that is sent next
    std::size_t sent_ = 0;   ///< entries that have been sent at least once
    std::size_t allowed_ = 0;
    std::size_t cut_ = 0;  ///< entries of the job; fewer once it is cancelled
    std::size_t bytes_in_flight_ = 0;
    std::vector<std::string> tail_;  ///< lines after a cancelled job
    int window_ = 1;

    bool query_pending_ = false;
    bool strays_ = false;  ///< lines that follow a refused one are still on their way
    bool killed_ = false;
    int meeting_rounds_ = 0;
    bool fault_pending_ = false;  ///< an error about lines was told, its Resend not yet
    std::optional<long> last_line_;
    int swallow_ok_ = 0;  ///< answers that belong to refused lines
    std::optional<Instant> hold_until_;
    int bad_resends_ = 0;
    int resends_of_line_ = 0;
    std::size_t resent_line_ = 0;
    std::vector<std::size_t> recent_resends_;  ///< by entry; the last hundred entries

    bool asks_for_m108_ = false;
    std::string prompt_;
    std::vector<std::string> choices_;  ///< of the prompt
    bool prompted_ = false;

    // Lines beside the job: without a number, so that the job's numbers stay what they are, and
    // only while no line of the job is on its way, so that every answer has one owner.
    std::deque<std::string> asides_;
    std::string aside_;          ///< on its way; empty: none
    int late_temperatures_ = 0;  ///< answers to M105 that may still come
    bool polls_ = false;         ///< the board does not report temperatures by itself
    Instant poll_at_{};
    double feed_percent_ = 100;  ///< that was asked for
    int feed_tries_ = 0;
    bool position_told_ = false;  ///< since the job asked for it

    Instant last_sign_{};
    Instant last_send_{};
    Instant silence_{};
    Instant stop_until_{};
    Progress counts_;
};

}  // namespace cam::protocol
