// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/board.h"
#include "cam/sim/wire.h"

#include <tl/expected.hpp>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace cam::sim {

/// A board at a pseudo-terminal. One thread of its own serves it from start() to stop().
class VirtualMachine {
  public:
    struct Options {
        long baud = 0;  ///< bytes take their time at this rate; 0: none
        Faults faults;
        std::string link;  ///< a symbolic link to the terminal, for a name that stays; empty: none
        bool banner = true;  ///< the board starts when the machine does
    };

    /// The board is used by the serving thread alone until stop(), but for what visit() does.
    VirtualMachine(std::unique_ptr<Board> board, Options options);
    VirtualMachine(const VirtualMachine&) = delete;
    VirtualMachine& operator=(const VirtualMachine&) = delete;
    VirtualMachine(VirtualMachine&&) = delete;
    VirtualMachine& operator=(VirtualMachine&&) = delete;
    ~VirtualMachine();

    /// @return nothing, or what the system refused
    [[nodiscard]] tl::expected<void, std::string> start();
    void stop();

    /// The link, or the terminal's own name: changes when the cable has been pulled.
    [[nodiscard]] std::string port() const;

    /// Calls `body` between two moments of the machine's life.
    void visit(const std::function<void(Board&, Wire&, Time)>& body);

    /// Pulls the cable for a while.
    void unplug(Time duration);

    [[nodiscard]] static Time now();

  private:
    bool open_terminal();
    void close_terminal();
    void serve();
    void exchange();
    void pull_cable(Time duration);
    Time idle_time();

    std::unique_ptr<Board> board_;
    Options options_;
    Wire wire_;
    int master_ = -1;
    int slave_ = -1;  ///< kept open: a terminal that nobody has open reports a hang-up for ever
    int wake_ = -1;
    std::string terminal_;
    std::string unsent_;
    bool unplugged_ = false;
    Time plug_at_{};
    mutable std::mutex mutex_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace cam::sim
