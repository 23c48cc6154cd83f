// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/grbl_parser.h"
#include "cam/sim/planner.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cam::sim {

struct PlcOptions {
    int slots = 4;
    int slot_regs = 121;
    int queue_lines = 64;
    Time scan = std::chrono::milliseconds(10);  ///< 0: one scan after every request
    bool combined = true;                       ///< has function 23
    bool retentive = false;                     ///< keeps its counters over a restart
    BoardOptions board;
};

/// A PLC with the G-code mailbox, written after docs/modbus-mailbox.md and with nothing of the
/// sender: registers, a scan that takes slots and commands, a queue of lines, motion.
class Plc {
  public:
    explicit Plc(PlcOptions options);

    /// What Modbus does between two scans. @return 0, or the exception
    [[nodiscard]] int read(unsigned address, unsigned count, std::vector<std::uint16_t>& out) const;
    [[nodiscard]] int write(unsigned address, const std::vector<std::uint16_t>& values);

    [[nodiscard]] const PlcOptions& options() const { return options_; }

    void scan(Time now);

    /// Power fails and comes back: motion and queue are lost.
    void restart(Time now);

    /// A fault of the machine: 4 a soft limit, 5 a drive …
    void alarm(std::uint16_t error);

    [[nodiscard]] std::uint32_t accepted() const { return accepted_; }

    [[nodiscard]] std::uint32_t executed() const { return executed_; }

    [[nodiscard]] Point position(Time now) const { return planner_.position(now); }

    [[nodiscard]] bool holds() const { return state_ == kHold; }

    [[nodiscard]] long damaged() const { return damaged_; }

    /// Called with every line when it is done, in order.
    std::function<void(std::string_view)> on_executed;

  private:
    static constexpr std::uint16_t kInit = 0;
    static constexpr std::uint16_t kIdle = 1;
    static constexpr std::uint16_t kRun = 2;
    static constexpr std::uint16_t kHold = 3;
    static constexpr std::uint16_t kAlarm = 4;
    static constexpr std::uint16_t kDone = 7;

    struct Line {
        std::uint32_t number = 0;
        std::string text;
        bool last = true;  ///< block of its line
    };

    enum class Taken { Nothing, Once, Waits, Gap, Damaged };

    [[nodiscard]] std::uint32_t two(std::size_t address) const;
    void put_two(std::size_t address, std::uint32_t value);
    void hear(Time now);
    void obey(Time now);
    void start(Time now);
    void take_slots();
    Taken take_slot(std::size_t slot);
    void plan(Time now);
    void move(const GrblBlock& block, Time now);
    void finish(Time now);
    void publish(Time now);
    void forget();

    PlcOptions options_;
    std::vector<std::uint16_t> regs_;
    Planner planner_;
    GrblParser parser_;
    std::deque<Line> queue_;
    std::deque<Line> planned_;               ///< one for each block of the planner
    std::vector<std::uint16_t> seen_;        ///< tags of slots that are dealt with
    std::vector<std::uint16_t> heard_tags_;  ///< tags of slots at the last scan
    std::uint16_t heard_tag_ = 0;
    std::uint16_t echo_ = 0;
    std::uint16_t nonce_ = 0;
    std::uint16_t state_ = kIdle;
    std::uint16_t error_ = 0;
    std::uint32_t error_line_ = 0;
    std::uint32_t job_ = 0;
    std::uint32_t accepted_ = 0;
    std::uint32_t executed_ = 0;
    std::uint32_t total_ = 0;
    std::uint32_t boot_ = 1;
    std::uint16_t doubled_ = 0;
    std::uint16_t watchdog_ms_ = 1000;
    bool stops_after_block_ = false;
    long damaged_ = 0;
    Time heard_{};
};

}  // namespace cam::sim
