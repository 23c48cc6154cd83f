// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/transport/channel.h"
#include "cam/transport/lock.h"

#include <optional>

namespace cam::transport::detail {

using ChannelResult = decomp::Result<std::unique_ptr<ByteChannel>>;

/// Through libserialport. Nothing: it does not know this kind of port.
[[nodiscard]] std::optional<ChannelResult> open_serial(const std::string& device,
                                                       const LineSettings& settings,
                                                       LockFile& lock);

/// A terminal without libserialport: pseudo-terminals, rfcomm.
[[nodiscard]] ChannelResult open_terminal(const std::string& device, const LineSettings& settings,
                                          LockFile lock);

/// `address` is HOST:PORT.
[[nodiscard]] ChannelResult open_tcp(const std::string& address);

/// Raw mode at any speed; errno is set when it fails.
[[nodiscard]] bool set_raw(int descriptor, const LineSettings& settings);

/// Whether DTR drops when the port is closed.
void set_hang_up(int descriptor, bool hang_up);

/// Drops DTR for a moment; without modem lines nothing happens.
void pulse_dtr(int descriptor);

/// Throws away what was written and has not left.
void discard_terminal_output(int descriptor);

[[nodiscard]] tl::unexpected<decomp::Error> unplugged(const std::string& name);

/// The error of an open() that failed with this errno.
[[nodiscard]] tl::unexpected<decomp::Error> not_opened(const std::string& name, int error_number);

}  // namespace cam::transport::detail
