// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/plc.h"

#include <tl/expected.hpp>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace cam::sim {

/// What goes wrong between a master and the PLC; shares are of requests.
struct ModbusFaults {
    std::uint64_t seed = 1;
    double drop_before = 0;  ///< lost before it is carried out (TCP: the connection too)
    double drop_after = 0;   ///< carried out, and the answer is lost
    double late = 0;         ///< answered late by up to `late_by`
    Time late_by{};
    double corrupt = 0;      ///< RTU: a byte of request or answer is flipped
    long restart_every = 0;  ///< lines; 0: never
};

/// "drop before 0.02", "drop after 0.02", "late 0.01 400ms", "corrupt 0.01", "restart every 5000",
/// "seed 7", one a line, '#' begins a comment. @return or the line that cannot be read
[[nodiscard]] tl::expected<ModbusFaults, std::string> read_modbus_faults(std::string_view script);

/// Serves a PLC over TCP or at a pseudo-terminal. Framing, checksums and exceptions are written
/// here: faults must lie between frame and machine, and nothing may be shared with the master's
/// library. One thread from start() to stop().
class ModbusServer {
  public:
    struct Options {
        std::string host = "127.0.0.1";
        int port = -1;     ///< of TCP; 0: any that is free; -1: a pseudo-terminal instead
        std::string link;  ///< a name for the pseudo-terminal; empty: its own
        int unit = 1;
        long baud = 0;  ///< answers come as late as this rate demands; 0: at once
        ModbusFaults faults;
    };

    ModbusServer(PlcOptions plc, Options options);
    ModbusServer(const ModbusServer&) = delete;
    ModbusServer& operator=(const ModbusServer&) = delete;
    ModbusServer(ModbusServer&&) = delete;
    ModbusServer& operator=(ModbusServer&&) = delete;
    ~ModbusServer();

    /// @return nothing, or what the system refused
    [[nodiscard]] tl::expected<void, std::string> start();
    void stop();

    /// As `hew stream --port` takes it.
    [[nodiscard]] const std::string& port() const { return port_; }

    /// Calls `body` between two moments of the machine's life.
    void visit(const std::function<void(Plc&, Time)>& body);

    [[nodiscard]] long requests() const { return requests_; }

  private:
    struct Peer {
        bool rtu = false;
        std::string in;
        Time last{};
    };

    struct Reply {
        Time due{};
        int descriptor = -1;
        std::string bytes;
    };

    bool listen_tcp();
    bool open_terminal();
    void serve();
    void accept_peer();
    bool hear(int descriptor, Time now);
    void take_frames(int descriptor, Peer& peer, Time now);
    bool frame(int descriptor, bool rtu, std::string head, const std::string& pdu, Time now);
    std::string carry_out(const std::string& pdu, Time now);
    void send_due(Time now);
    void drop_peer(int descriptor);
    bool chance(double share);

    Plc plc_;
    Options options_;
    std::string port_;
    int listener_ = -1;
    int slave_ = -1;
    int wake_ = -1;
    std::map<int, Peer> peers_;
    std::vector<Reply> replies_;
    std::mt19937_64 random_;
    std::atomic<long> requests_{0};
    long restart_at_ = 0;
    Time scan_at_{};
    std::mutex mutex_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace cam::sim
