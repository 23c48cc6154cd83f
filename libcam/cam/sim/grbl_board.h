// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/board.h"
#include "cam/sim/grbl_parser.h"
#include "cam/sim/planner.h"

#include <array>
#include <deque>
#include <string>

namespace cam::sim {

/// A mill's controller that behaves as Grbl 1.1 does at its serial port: realtime bytes taken out
/// of the stream, a receive buffer that overflows, a planner, check mode, holds, alarms, resets.
class GrblBoard final : public Board {
  public:
    explicit GrblBoard(const BoardOptions& options);

    void reset(Time now) override;
    void receive(std::string_view bytes, Time now) override;
    void advance(Time now) override;
    [[nodiscard]] std::optional<Time> next() const override;
    [[nodiscard]] std::string take_output() override;

    [[nodiscard]] std::size_t overflowed() const override { return overflowed_; }

    /// The most bytes that ever waited in the receive buffer.
    [[nodiscard]] std::size_t fullest() const { return fullest_; }

    /// Whether feed motion is going on.
    [[nodiscard]] bool moving() const { return state_ == State::Run; }

    [[nodiscard]] Point position(Time now) const { return planner_.position(now); }

    /// The limit switch of an axis is hit.
    void hit_limit(Time now);

    /// Shifts the work coordinates: G54's offset, mm.
    void set_work_offset(const Point& offset) { offsets_[0] = offset; }

  private:
    enum class State { Idle, Run, Hold, Alarm, Check };

    void realtime(unsigned char byte, Time now);
    bool take_line(Time now);
    void answer(const std::string& line, Time now);
    bool tell(const std::string& line);
    int command(const std::string& line);
    bool run_block(Time now);
    void soft_reset(Time now);
    void report(Time now);
    void update(Time now);
    [[nodiscard]] Point work_offset() const;
    [[nodiscard]] std::string values(const Point& point) const;

    BoardOptions options_;
    Planner planner_;
    GrblParser parser_;
    std::string out_;
    std::deque<char> buffer_;
    std::size_t overflowed_ = 0;
    std::size_t fullest_ = 0;
    std::string partial_;
    bool overlong_ = false;

    State state_ = State::Idle;
    std::array<Point, 6> offsets_{};
    bool blocked_ = false;  ///< a parsed line waits for room in the planner or for its end
    bool draining_ = false;
    GrblBlock waiting_;
    std::size_t chord_ = 0;  ///< of waiting_, planned next
    std::string waiting_text_;
    double feed_override_ = 1;
    int reports_ = 0;
    bool reset_after_answer_ = false;
    Point checked_{};  ///< where the check mode believes the machine to be
};

}  // namespace cam::sim
