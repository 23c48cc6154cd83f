// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

/// Virtual machines. This room sees no other room: nothing that sends a job can be mistaken in the
/// same way as that which receives it.
namespace cam::sim {

/// Time since an arbitrary start.
using Time = std::chrono::nanoseconds;

/// A controller at the end of a serial line.
class Board {
  public:
    Board() = default;
    Board(const Board&) = delete;
    Board& operator=(const Board&) = delete;
    Board(Board&&) = delete;
    Board& operator=(Board&&) = delete;
    virtual ~Board() = default;

    /// Power comes on, or the reset line is pulled.
    virtual void reset(Time now) = 0;

    /// Bytes reach the receiver; what does not fit into its buffer is lost.
    virtual void receive(std::string_view bytes, Time now) = 0;

    /// Does what there is to do until `now`.
    virtual void advance(Time now) = 0;

    /// When advance() has something to do next, without new bytes.
    [[nodiscard]] virtual std::optional<Time> next() const = 0;

    /// What it has sent since the last call.
    [[nodiscard]] virtual std::string take_output() = 0;

    /// Bytes that were lost because the receive buffer was full.
    [[nodiscard]] virtual std::size_t overflowed() const = 0;

    /// Called with every command of a program in the order in which they are carried out (queued
    /// for motion), without number and checksum.
    std::function<void(std::string_view)> on_executed;
};

/// Figures of a virtual machine.
struct BoardOptions {
    std::size_t receive_bytes = 128;
    int planner_blocks = 16;
    bool instant = false;  ///< motion, heating and dwelling take no time
    double speed = 1;      ///< time runs this many times faster in the machine
    double max_mm_per_s = 200;
    double acceleration_mm_per_s2 = 1000;
    // Marlin
    bool emergency_parser = true;
    bool advanced_ok = false;
    bool autoreport = true;  ///< temperatures by itself (M155)
    // Grbl
    int axes = 3;
    bool homing = false;  ///< locked after power-up until homed
};

}  // namespace cam::sim
