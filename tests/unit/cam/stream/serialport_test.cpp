// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/marlin_board.h"
#include "cam/sim/virtual_machine.h"
#include "cam/transport/channel.h"

#include <gtest/gtest.h>
#include <termios.h>

#include <string>

namespace tests {
extern std::string dtr_changes;  // by the program, '+' raised and '-' dropped; modemless_terminals
}

namespace {

/// What libserialport leaves behind, which sets HUPCL when it opens a port.
bool hangs_up(const cam::transport::ByteChannel& channel) {
    termios modes{};
    EXPECT_EQ(::tcgetattr(channel.descriptor(), &modes), 0);
    return (modes.c_cflag & HUPCL) != 0;
}

TEST(Serialport, LeavesTheLineUpAndPulsesDtrOnlyWhereTheProfileSaysSo) {
    cam::sim::VirtualMachine machine(
        std::make_unique<cam::sim::MarlinBoard>(cam::sim::BoardOptions{}), {});
    ASSERT_TRUE(machine.start());
    tests::dtr_changes.clear();
    {
        const auto channel = cam::transport::open_channel(machine.port(), {});
        ASSERT_TRUE(channel) << channel.error().text();
        EXPECT_FALSE(hangs_up(**channel));
        EXPECT_EQ(tests::dtr_changes.find('-'), std::string::npos);
    }
    {
        const auto channel = cam::transport::open_channel(machine.port(), {.reset_on_close = true});
        ASSERT_TRUE(channel);
        EXPECT_TRUE(hangs_up(**channel));
    }
    tests::dtr_changes.clear();
    const auto channel = cam::transport::open_channel(machine.port(), {.pulse_dtr = true});
    ASSERT_TRUE(channel);
    ASSERT_GE(tests::dtr_changes.size(), 2U);
    EXPECT_EQ(tests::dtr_changes.substr(tests::dtr_changes.size() - 2), "-+");
}

TEST(Serialport, CarriesTheSessionsOfThisSuite) {
    cam::sim::VirtualMachine machine(
        std::make_unique<cam::sim::MarlinBoard>(cam::sim::BoardOptions{}), {});
    ASSERT_TRUE(machine.start());
    for (const int baud : {9600, 115200, 250000, 1000000}) {
        const auto channel = cam::transport::open_channel(machine.port(), {.baud = baud});
        ASSERT_TRUE(channel) << channel.error().text();
        EXPECT_EQ((*channel)->kind(), "libserialport");
    }
}

}  // namespace
