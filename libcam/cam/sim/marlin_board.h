// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/board.h"
#include "cam/sim/planner.h"

#include <array>
#include <deque>
#include <string>
#include <vector>

namespace cam::sim {

/// A printer's controller that behaves as Marlin 2.0.9 does at its serial port: a receive buffer
/// that overflows, four commands in its queue, numbered lines with checksums, the whole buffer
/// thrown away at an error, "ok" when a command has been carried out or planned.
class MarlinBoard final : public Board {
  public:
    explicit MarlinBoard(const BoardOptions& options);

    void reset(Time now) override;
    void receive(std::string_view bytes, Time now) override;
    void advance(Time now) override;
    [[nodiscard]] std::optional<Time> next() const override;
    [[nodiscard]] std::string take_output() override;

    [[nodiscard]] std::size_t overflowed() const override { return overflowed_; }

    [[nodiscard]] long last_number() const { return last_number_; }

    [[nodiscard]] long refused() const { return refused_; }

    [[nodiscard]] bool halted() const { return halted_; }

    [[nodiscard]] Point position(Time now) const { return planner_.position(now); }

    [[nodiscard]] double feed_percent() const { return feed_percent_; }

    /// Choices that it was told by M876, in their order.
    [[nodiscard]] const std::vector<int>& answers() const { return answers_; }

    /// Says something of its own accord.
    void say(std::string_view line) { out_ += std::string(line) + "\n"; }

  private:
    enum class Wait { None, Slot, Drain, Until, User };

    struct Heater {
        double celsius = 21;
        double target = 0;
    };

    void scan_emergency(char byte, Time now);
    void take_lines(Time now);
    void line(std::string text, Time now);
    void refuse(const char* why);
    bool work(Time now);
    void start(const std::string& text, Time now);
    void general(int code, const std::string& text, Time now);
    void miscellaneous(int code, const std::string& text, Time now);
    void set_place(const std::string& text);
    void move(int code, const std::string& text);
    void identify();
    void finish(Time now);
    void heat(Heater& heater, const std::string& text, bool wait, Time now);
    void warm(Time now);
    void halt();
    [[nodiscard]] std::string temperatures() const;
    [[nodiscard]] std::string place_text(Time now) const;

    BoardOptions options_;
    Planner planner_;
    std::string out_;
    std::deque<char> buffer_;
    std::size_t overflowed_ = 0;
    std::string partial_;
    bool in_comment_ = false;
    std::string emergency_;

    struct Queued {
        std::string text;
        long number = -1;
    };

    std::deque<Queued> queue_;
    Queued current_;
    bool working_ = false;
    Wait wait_ = Wait::None;
    Time until_{};
    bool heating_ = false;
    std::vector<Point> chords_;  ///< of the current move; one when it is straight
    std::size_t chord_ = 0;
    double pending_speed_ = 0;
    double feed_percent_ = 100;
    std::vector<int> answers_;  ///< to prompts

    long last_number_ = 0;
    long refused_ = 0;
    bool halted_ = false;
    bool absolute_ = true;
    bool absolute_e_ = true;
    double feed_mm_per_s_ = 50;
    Heater nozzle_;
    Heater bed_;
    Time warmed_{};
    int report_seconds_ = 0;
    Time next_report_{};
    int place_seconds_ = 0;
    Time next_place_{};
    Time next_busy_{};
};

}  // namespace cam::sim
