// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace cam::transport {

/// How a serial line is set up: eight bits, no parity, one stop bit, no echo, nothing translated.
struct LineSettings {
    int baud = 115200;
    bool rts_cts = false;         ///< hardware flow control
    bool reset_on_close = false;  ///< DTR drops when the port is closed (HUPCL)
    bool pulse_dtr = false;       ///< DTR is dropped for 100 ms after opening, to reset the board
};

/// An open two-way line of bytes. Nothing here waits.
class ByteChannel {
  public:
    ByteChannel() = default;
    ByteChannel(const ByteChannel&) = delete;
    ByteChannel& operator=(const ByteChannel&) = delete;
    ByteChannel(ByteChannel&&) = delete;
    ByteChannel& operator=(ByteChannel&&) = delete;
    virtual ~ByteChannel() = default;

    /// For poll().
    [[nodiscard]] virtual int descriptor() const = 0;

    /// Reads what is there, at most `size` bytes; 0: nothing. To be called when poll() reports
    /// anything. @error transport.unplugged
    [[nodiscard]] virtual decomp::Result<std::size_t> read(char* bytes, std::size_t size) = 0;

    /// Writes what fits; 0: nothing does. @error transport.unplugged
    [[nodiscard]] virtual decomp::Result<std::size_t> write(std::string_view bytes) = 0;

    /// Throws away what was written and has not left yet.
    virtual void discard_output() = 0;

    /// "libserialport", "terminal" or "TCP"
    [[nodiscard]] virtual std::string_view kind() const = 0;
};

/// Opens a port and takes it for this process alone, by a lock file, flock() and TIOCEXCL.
/// @param port  a device ("/dev/ttyUSB0", a by-id name), a pseudo-terminal, or "tcp:HOST:PORT".
///              Serial devices go through libserialport; what it cannot open and is a terminal is
///              opened directly.
/// @error transport.not_found, transport.no_permission, transport.busy (with the process that holds
/// it), transport.bad_name, transport.refused (the system's own words)
[[nodiscard]] decomp::Result<std::unique_ptr<ByteChannel>> open_channel(
    const std::string& port, const LineSettings& settings);

}  // namespace cam::transport
