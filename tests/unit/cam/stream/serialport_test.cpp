// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/marlin_board.h"
#include "cam/sim/virtual_machine.h"
#include "cam/transport/channel.h"

#include <gtest/gtest.h>

namespace {

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
