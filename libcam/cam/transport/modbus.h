// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/transport/channel.h"

#include <chrono>
#include <string>

namespace cam::transport {

/// How a Modbus machine is reached.
struct ModbusSettings {
    int unit = 1;
    std::chrono::milliseconds timeout{300};  ///< until an answer is given up
    int baud = 19200;                        ///< of a serial line: a usual rate, nothing between
    char parity = 'E';                       ///< 'N', 'E' or 'O'
    int stop_bits = 1;
};

/// Opens a Modbus master and takes the machine for this process alone. What is written are
/// requests, what is read their answers: two bytes length, high byte first, a tag, the protocol
/// data unit (functions 3, 4, 16, 23). Each request has exactly one answer with its tag, in order;
/// function code 0 says that none came, the byte after it why: 1 timeout, 2 garbled, 3 no
/// connection. After that the link is flushed (RTU) or made anew (TCP) before the next request
/// leaves.
///
/// A thread of its own carries the requests out through libmodbus, one at a time, with the silence
/// between frames that RTU asks for; libmodbus' own recovery is never used.
/// @param port  "tcp:HOST:PORT" or a serial device
/// @error as open_channel()
[[nodiscard]] decomp::Result<std::unique_ptr<ByteChannel>> open_modbus(
    const std::string& port, const ModbusSettings& settings);

/// Whether the host of "tcp:HOST:PORT" lies outside loopback, private (RFC 1918, fc00::/7) and
/// link-local ranges: Modbus knows neither names nor passwords. Serial devices and names that
/// cannot be resolved: false.
[[nodiscard]] bool is_public_address(const std::string& port);

}  // namespace cam::transport
