// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/mailbox_map.h"
#include "cam/protocol/modbus_pdu.h"
#include "cam/protocol/protocol.h"

#include <deque>
#include <optional>
#include <string>

namespace cam::protocol {

/// Figures of a mailbox; profiles give them.
struct MailboxOptions {
    MailboxMap map = MailboxMap::version_1();
    Instant timeout = std::chrono::milliseconds(300);  ///< until an answer is given up
    Instant meeting_wait = std::chrono::seconds(5);    ///< until somebody must have answered
    Instant patience = std::chrono::minutes(10);       ///< without an answer: give up
    Instant poll = std::chrono::milliseconds(50);      ///< of the status, at the slowest
    Instant watchdog = std::chrono::milliseconds(1500);
    double position_tolerance_mm = 0.01;
};

/// The conversation with a PLC that has the G-code mailbox: docs/modbus-mailbox.md.
///
/// Line i of the job travels as number i + 1 in one of K slots; the PLC takes a slot only when its
/// first number follows the last one it has, so whatever is lost, late or sent twice, each line is
/// taken once. One request is on its way at a time. After any failure the bus is left silent for
/// two timeouts (longer each time), then the machine is asked who it is, and a tag that was never
/// used before must come back in its status before anything that it says is believed.
class Mailbox final : public Protocol {
  public:
    /// `job` must outlive this.
    Mailbox(const JobLines& job, MailboxOptions options);

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

    /// Number of this job for the machine: CRC-32 of its lines, never 0.
    [[nodiscard]] std::uint32_t job_number() const { return job_number_; }

  private:
    enum class Step { Down, Silent, Identify, First, Confirm, Working };
    enum class Request { Identity, Job, Write, Status };

    struct Block {
        std::size_t first = 0;
        std::size_t count = 0;
        Instant sent_at{};
    };

    struct Pending {
        PlcCommand command = PlcCommand::None;
        std::uint16_t nonce = 0;
        Instant since{};
    };

    void next(Instant now);
    void work(Instant now);
    void send(Request request, const std::string& bytes, Instant now);
    void ask_identity(Instant now);
    void ask_status(Instant now);
    void exchange(std::uint16_t address, const Registers& values, Instant now);
    void beat(Instant now);
    void send_command(Instant now);
    void send_block(Instant now);
    [[nodiscard]] bool may_send() const;
    void answer(const ModbusAnswer& answer, Instant now);
    void exception(const ModbusAnswer& answer, Instant now);
    void on_identity(const Registers& in, Instant now);
    void on_status(const Registers& in, Instant now);
    void take_status(const PlcStatus& status);
    void meet_status(const PlcStatus& status, Instant now);
    bool follow_count(const PlcStatus& status, Instant now);
    void follow_state(const PlcStatus& status, Instant now);
    void follow_barrier(const PlcStatus& status);
    void follow_command(const PlcStatus& status, Instant now);
    void reached(PlcCommand command, Instant now);
    void order(PlcCommand command, Instant now);
    void go_back();
    void recover(Instant now);
    void fail(std::string code, std::string text);
    void emit(Event::Kind kind, std::string text = {}, long line = 0);
    [[nodiscard]] std::uint16_t new_tag();
    [[nodiscard]] std::size_t end_of_block() const;

    const JobLines& job_;
    MailboxOptions options_;
    std::uint32_t job_number_ = 1;
    Phase phase_ = Phase::Closed;
    Step step_ = Step::Down;
    Meeting meeting_ = Meeting::Fresh;
    Output out_;
    Identity identity_;
    Status status_;
    AnswerReader reader_;

    std::optional<Request> in_flight_;
    std::uint8_t request_tag_ = 0;
    Instant guard_{};         ///< an answer must have come by then
    Instant silent_until_{};  ///< of Step::Silent
    Instant poll_at_{};
    Instant poll_gap_{};
    Instant last_answer_{};
    int failures_ = 0;  ///< in a row

    std::optional<PlcIdentity> plc_;
    std::optional<PlcStatus> last_;
    std::uint16_t tag_ = 0;
    std::uint16_t echo_ = 0;  ///< of the last status believed
    std::uint16_t confirm_tag_ = 0;
    std::uint16_t nonce_ = 0;
    std::optional<Pending> pending_;
    std::optional<std::uint16_t> override_;  ///< per cent, to be written
    bool job_written_ = false;
    bool ours_ = false;  ///< the machine has told that it works on this job
    bool kills_ = false;
    bool machine_asks_ = false;

    std::deque<Block> blocks_;  ///< written and not yet taken, oldest first
    std::size_t block_number_ = 0;
    std::size_t first_ = 0;  ///< entry of the start command
    std::size_t next_ = 0;
    std::size_t accepted_ = 0;
    std::size_t executed_ = 0;
    std::size_t sent_ = 0;
    std::size_t allowed_ = 0;
    std::size_t queue_lines_ = 1;         ///< of the machine, as far as it has told
    std::optional<std::size_t> barrier_;  ///< nothing follows until so many are carried out
    std::size_t passed_ = 0;              ///< the last such place that is behind us
    Progress counts_;
};

}  // namespace cam::protocol
