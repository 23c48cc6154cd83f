// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/mailbox.h"
#include "cam/sim/modbus_server.h"
#include "cam/transport/modbus.h"
#include "tests/support/streaming.h"
#include "tests/support/temp_dir.h"

namespace tests {

/// A job over libmodbus to a virtual PLC.
struct ModbusRun {
    cam::sim::PlcOptions plc;
    cam::sim::ModbusServer::Options server;
    cam::protocol::MailboxOptions options;
    cam::transport::ModbusSettings line;
    Executed executed;
    cam::stream::Outcome outcome;
    long requests = 0;
    long restarts = 0;
    std::function<void(cam::stream::Session&, const cam::stream::Notice&)> on_notice;

    ModbusRun() {
        plc.board.instant = true;
        plc.scan = std::chrono::milliseconds(0);
        server.port = 0;
        set_timeout(std::chrono::milliseconds(100));
    }

    void set_timeout(std::chrono::milliseconds timeout) {
        line.timeout = timeout;
        options.timeout = timeout;
        // Longer than any silence of the fault scripts: holding has tests of its own.
        options.watchdog = std::chrono::seconds(60);
    }

    /// @param confirmed  after a restart of the PLC the operator has it go on behind what is done
    void stream(std::size_t lines, bool confirmed = false) {
        const TempDir folder;
        if (server.port < 0) {
            server.link = folder / "plc";
        }
        cam::sim::ModbusServer machine(plc, server);
        executed.wanted = mill_line;
        machine.visit([&](cam::sim::Plc& one, cam::sim::Time) {
            one.on_executed = [this](std::string_view text) { executed.take(text); };
        });
        const auto started = machine.start();
        ASSERT_TRUE(started) << started.error();
        const std::string port = machine.port();
        std::size_t done = 0;
        do {
            cam::protocol::JobLines job;
            for (std::size_t i = done; i < lines; ++i) {
                job.add(mill_line(i), static_cast<long>(i + 1));
            }
            cam::protocol::Mailbox conversation(job, options);
            cam::stream::Session::Options session_options;
            cam::stream::Session* here = nullptr;
            session_options.tell = [&](const cam::stream::Notice& notice) {
                if (on_notice) {
                    on_notice(*here, notice);
                }
            };
            cam::stream::Session session(
                conversation, [&] { return cam::transport::open_modbus(port, line); },
                session_options);
            here = &session;
            const auto ended = session.run();
            ASSERT_TRUE(ended) << ended.error().text();
            outcome = *ended;
            done = executed.count;
        } while (confirmed && outcome.code == "protocol.machine_reset" && ++restarts > 0);
        machine.stop();
        requests = machine.requests();
    }

    void expect_perfect(std::size_t lines) const {
        EXPECT_EQ(outcome.phase, cam::protocol::Phase::Finished)
            << outcome.code << ": " << outcome.text;
        EXPECT_EQ(executed.count, lines);
        EXPECT_EQ(executed.changed, 0U) << executed.first_difference;
        EXPECT_EQ(executed.added, 0U) << executed.first_difference;
    }
};

}  // namespace tests
