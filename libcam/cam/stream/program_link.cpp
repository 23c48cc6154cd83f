// SPDX-License-Identifier: GPL-3.0-or-later
// What the link of a machine decides: conversation, port and figures of both.
#include "cam/protocol/grbl.h"
#include "cam/protocol/mailbox.h"
#include "cam/protocol/marlin.h"
#include "cam/stream/stream_program.h"
#include "cam/transport/modbus.h"

#include <algorithm>
#include <cmath>

namespace cam::stream {

using decomp::fail;
using decomp::Status;

namespace {

protocol::Instant seconds(double value) {
    return protocol::Instant(static_cast<protocol::Instant::rep>(value * 1e9));
}

}  // namespace

protocol::LinkOptions ProgramStream::link_options() const {
    const profile::Link::Line& line = request_.link.line;
    protocol::LinkOptions options;
    options.banner_wait = seconds(line.banner_wait_s);
    options.expects_banner = line.reset_on_open && !same_board_;
    options.silence = seconds(line.silence_s);
    options.patience = seconds(line.patience_s);
    options.receive_bytes = static_cast<std::size_t>(line.receive_bytes);
    options.window = line.window;
    options.max_resend_fraction = line.max_resend_fraction;
    options.precheck = line.precheck;
    options.offers_homing = std::find(request_.allowed.begin(), request_.allowed.end(),
                                      "not_homed") == request_.allowed.end();
    return options;
}

Status ProgramStream::make_conversation() {
    if (!is_modbus()) {
        if (is_mill()) {
            conversation_ = std::make_unique<protocol::Grbl>(job_.lines, link_options());
        } else {
            conversation_ = std::make_unique<protocol::Marlin>(job_.lines, link_options());
        }
        return {};
    }
    const profile::Link::Modbus& modbus = request_.link.modbus;
    auto map = protocol::read_mailbox_map(modbus.registers);
    if (!map) {
        return fail(map.error());
    }
    protocol::MailboxOptions options;
    options.map = *map;
    options.map.combined = modbus.combined;
    options.map.read_function = static_cast<std::uint8_t>(modbus.read_function);
    options.map.low_word_first = modbus.low_word_first;
    options.map.low_byte_first = modbus.low_byte_first;
    options.timeout = seconds(modbus.timeout_s);
    options.watchdog = seconds(modbus.watchdog_s);
    options.poll = std::min(options.poll, options.watchdog / 4);
    options.meeting_wait = seconds(request_.link.line.banner_wait_s);
    options.patience = seconds(request_.link.line.patience_s);
    conversation_ = std::make_unique<protocol::Mailbox>(job_.lines, options);
    return {};
}

Session::Open ProgramStream::opener() const {
    const std::string port = request_.port;
    const profile::Link& link = request_.link;
    if (is_modbus()) {
        transport::ModbusSettings settings;
        settings.unit = link.modbus.unit;
        settings.timeout = std::chrono::milliseconds(std::lround(1000 * link.modbus.timeout_s));
        settings.baud = link.line.baud;
        settings.parity = link.modbus.parity.front();
        settings.stop_bits = link.modbus.stop_bits;
        return [port, settings] { return transport::open_modbus(port, settings); };
    }
    const transport::LineSettings line{link.line.baud, link.line.rts_cts, link.line.reset_on_close,
                                       link.line.pulse_dtr};
    return [port, line] { return transport::open_channel(port, line); };
}

}  // namespace cam::stream
