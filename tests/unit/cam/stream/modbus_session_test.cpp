// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/modbus_run.h"

namespace {

using namespace std::chrono_literals;
using cam::protocol::Event;
using cam::protocol::Phase;
using cam::protocol::Wish;
using cam::stream::Notice;
using cam::stream::Session;
using tests::ModbusRun;

TEST(ModbusSession, EveryLineIsCarriedOutOnceAndInOrderOverTcp) {
    ModbusRun run;
    run.stream(3000);
    run.expect_perfect(3000);
}

TEST(ModbusSession, AndOverAPseudoTerminal) {
    ModbusRun run;
    run.server.port = -1;
    run.stream(500);
    run.expect_perfect(500);
}

TEST(ModbusSession, LostConnectionsAndLateAnswersLoseAndDoubleNothing) {
    ModbusRun run;
    run.set_timeout(30ms);
    run.server.faults = {1, 0.02, 0.02, 0.01, 60ms, 0, 0};
    run.plc.slot_regs = 30;
    run.stream(1500);
    run.expect_perfect(1500);
    EXPECT_GT(run.outcome.progress.lost_answers, 5);
}

TEST(ModbusSession, DamagedFramesOfASerialLineLoseAndDoubleNothing) {
    ModbusRun run;
    run.set_timeout(30ms);
    run.server.port = -1;
    run.server.faults = {1, 0.02, 0.02, 0.02, 60ms, 0.05, 0};
    run.plc.slot_regs = 40;
    run.stream(500);
    run.expect_perfect(500);
    EXPECT_GT(run.outcome.progress.lost_answers, 5);
}

TEST(ModbusSession, ARestartedPlcEndsTheJobAndAConfirmedOneGoesOnBehindWhatIsDone) {
    ModbusRun run;
    run.server.faults.restart_every = 300;
    run.stream(1000);
    EXPECT_EQ(run.outcome.phase, Phase::Failed);
    EXPECT_EQ(run.outcome.code, "protocol.machine_reset");
    EXPECT_LT(run.executed.count, 1000U);

    ModbusRun confirmed;
    confirmed.server.faults.restart_every = 300;
    confirmed.stream(1000, true);
    confirmed.expect_perfect(1000);
    EXPECT_GE(confirmed.restarts, 2);
}

TEST(ModbusSession, AStopFromTheOperatorEndsMotion) {
    ModbusRun run;
    run.plc.board.instant = false;
    run.plc.board.max_mm_per_s = 30;
    run.plc.scan = 2ms;
    run.on_notice = [](Session& session, const Notice& notice) {
        if (notice.kind == Notice::Kind::Told && notice.progress.acked > 1) {
            session.post(Wish::Cancel);
        }
    };
    run.stream(2000);
    EXPECT_EQ(run.outcome.phase, Phase::Stopped);
    EXPECT_LT(run.executed.count, 2000U);
}

TEST(ModbusTransport, RatesThatLibmodbusWouldReplaceSilentlyAndStrangePortsAreRefused) {
    const auto odd = cam::transport::open_modbus("/dev/null", {1, 100ms, 250000, 'N', 1});
    ASSERT_FALSE(odd);
    EXPECT_EQ(odd.error().code, "transport.bad_name");
    const auto nobody = cam::transport::open_modbus("tcp:127.0.0.1:1", {});
    ASSERT_FALSE(nobody);
    EXPECT_FALSE(cam::transport::open_modbus("/dev/not-there", {}));
}

TEST(ModbusTransport, OnlyAddressesOutsidePrivateNetworksAreWarnedOf) {
    for (const char* inside : {"tcp:127.0.0.1:502", "tcp:10.1.2.3:502", "tcp:172.31.0.1:502",
                               "tcp:192.168.7.7:502", "tcp:169.254.1.1:502", "/dev/ttyS0"}) {
        EXPECT_FALSE(cam::transport::is_public_address(inside)) << inside;
    }
    for (const char* outside : {"tcp:8.8.8.8:502", "tcp:172.32.0.1:502", "tcp:192.169.0.1:502"}) {
        EXPECT_TRUE(cam::transport::is_public_address(outside)) << outside;
    }
}

TEST(ModbusTransport, ASecondSenderIsTurnedAway) {
    if (::access("/run/lock", W_OK) != 0) {
        GTEST_SKIP() << "no lock files here";
    }
    cam::sim::ModbusServer machine({}, {"127.0.0.1", 0, "", 1, 0, {}});
    ASSERT_TRUE(machine.start());
    const auto first = cam::transport::open_modbus(machine.port(), {});
    ASSERT_TRUE(first) << first.error().text();
    const auto second = cam::transport::open_modbus(machine.port(), {});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, "transport.busy");
}

}  // namespace
