// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/read_profile.h"
#include "decomp/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace cam::profile {

/// How a machine is connected and recognised. Read from machine_profiles/links/NAME.toml, where
/// NAME is that of the printer or mill: a link belongs to one machine on one table, a proof to
/// every machine of its kind, so no link is part of a set-up's hash.
struct Link {
    std::string name;

    struct Line {
        std::string protocol;  ///< "marlin", "grbl", "modbus" or "card"
        int baud = 115200;
        bool rts_cts = false;
        bool reset_on_open = true;    ///< the board restarts when the port is opened
        bool reset_on_close = false;  ///< let DTR drop on closing (HUPCL)
        bool pulse_dtr = false;
        double banner_wait_s = 5;
        double silence_s = 5;
        double patience_s = 600;
        int receive_bytes = 127;
        int window = 1;
        double max_resend_fraction = 0.1;
        bool precheck = true;
    } line;

    /// What the connected machine must be.
    struct Identity {
        std::string firmware;
        std::string machine;
        std::vector<std::string> usb;  ///< "2c99:0002"
    } identity;

    /// For mills.
    struct Mill {
        double max_feed_mm_per_min = 3000;
        double max_spindle_rpm = 24000;
        double spin_up_s = 4;
        bool parks = true;      ///< rises before a change of tool
        double park_z_mm = -2;  ///< machine coordinates
    } mill;

    /// For machines with the G-code mailbox.
    struct Modbus {
        std::string port;  ///< for --port auto: "tcp:HOST:PORT" or a device; empty: none
        int unit = 1;
        double timeout_s = 0.3;
        double watchdog_s = 1.5;
        std::string parity = "E";
        int stop_bits = 1;
        bool combined = true;
        int read_function = 3;
        bool low_word_first = false;
        bool low_byte_first = false;
        std::vector<std::string> registers;  ///< "NAME=ADDRESS" of those that lie elsewhere
    } modbus;
};

/// The link of a machine; `machine` is a name or a path as for read_fdm_setup(); `settings` as
/// there ("link.baud=250000").
/// @error profile.not_found and the others of read_fdm_setup()
[[nodiscard]] decomp::Result<Link> read_link(std::string_view machine,
                                             const std::vector<std::string>& settings = {});

/// Every field of a link.
[[nodiscard]] std::vector<FieldRow> describe(const Link& link);

}  // namespace cam::profile
