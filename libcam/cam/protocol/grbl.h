// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/grbl_reply.h"
#include "cam/protocol/line_splitter.h"
#include "cam/protocol/protocol.h"

#include <deque>
#include <string>

namespace cam::protocol {

/// The conversation with Grbl 1.1, grblHAL and FluidNC: character counting with one byte of the
/// receive buffer kept free, realtime bytes outside the count, the whole job in check mode first.
///
/// These firmwares have neither checksums nor line numbers: a digit that flips on the way is
/// carried out. What can be seen (an error, an alarm, a banner, an answer that nobody could have
/// given, one answer too many, silence with lines outstanding) stops the feed at once.
class Grbl final : public Protocol {
  public:
    /// `job` must outlive this.
    Grbl(const JobLines& job, LinkOptions options);

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
    enum class Step { Banner, Look, Version, Settings, Offsets, Place, Homing, Done };
    /// On the way into and out of check mode.
    enum class Check { None, Entering, Reading, Leaving, AwaitingBanner };

    void reply(std::string_view line, Instant now);
    void on_ok(Instant now);
    void on_error(int number, Instant now);
    void on_status(const GrblReply& reply, Instant now);
    void on_banner(Instant now);
    void meeting_reply(const GrblReply& reply, Instant now);
    void take_facts(const GrblReply& reply);
    void enter(Step step, Instant now);
    void say_step(Instant now);
    void known();
    void resume(Instant now);
    void stop(Wish wish, Instant now);
    void begin_check(Instant now);
    void begin_running(Instant now);
    void fill(Instant now);
    void settle(Instant now);
    void settled(Instant now);
    void halt(std::string code, std::string text, Instant now);
    void finish_halt();
    void fail(std::string code, std::string text);
    void emit(Event::Kind kind, std::string text = {}, long line = 0);
    [[nodiscard]] std::size_t window() const;
    [[nodiscard]] bool streams() const;
    [[nodiscard]] std::string entry_words(std::size_t entry) const;

    const JobLines& job_;
    LinkOptions options_;
    Phase phase_ = Phase::Closed;
    Output out_;
    Identity identity_;
    Status status_;
    LineSplitter splitter_;

    Step step_ = Step::Banner;
    int step_tries_ = 0;
    Instant step_until_{};
    bool saw_banner_ = false;
    bool offers_homing_ = false;  ///< the question is open

    Check check_ = Check::None;
    Instant check_until_{};
    std::size_t first_ = 0;

    std::deque<std::size_t> in_flight_;  ///< bytes of every line not answered
    std::size_t bytes_in_flight_ = 0;
    std::size_t acked_ = 0;
    std::size_t next_ = 0;
    std::size_t allowed_ = 0;

    bool settling_ = false;  ///< a Drain entry is done; the next Idle report tells where we are
    Instant settle_since_{};
    std::optional<AxisValues> work_offset_;

    bool halting_ = false;
    Instant halt_until_{};
    std::string halt_code_;
    std::string halt_text_;
    std::size_t halt_line_ = 0;

    bool paused_here_ = false;
    Instant pause_at_{};
    Instant last_status_{};
    Instant last_poll_{};
    Instant last_ok_{};
    Instant idle_since_{};
    bool idle_ = false;
    Progress counts_;
};

}  // namespace cam::protocol
