// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <string>
#include <vector>

namespace cam::transport {

/// A serial port of this computer.
struct Port {
    std::string name;         ///< "/dev/ttyUSB0"
    std::string description;  ///< of its driver or its maker
    std::string by_id;        ///< a name that stays: "/dev/serial/by-id/…"; empty: none
    std::string usb;          ///< "2341:0042", vendor and product; empty: not on USB
    std::string usb_serial;
    std::string manufacturer;
    std::string product;
    bool accessible = false;  ///< this user may open it
};

/// All serial ports, sorted by name; those that the kernel lists without hardware behind them are
/// left out. @error transport.refused
[[nodiscard]] decomp::Result<std::vector<Port>> list_ports();

}  // namespace cam::transport
