// SPDX-License-Identifier: GPL-3.0-or-later
// Many lines over Modbus with every fault at once. HEW_SOAK_LINES says how many.
#include "tests/support/modbus_run.h"

#include <cstdlib>
#include <iostream>

namespace {

using namespace std::chrono_literals;
using tests::ModbusRun;

std::size_t lines_to_stream(std::size_t unless) {
    const char* text = std::getenv("HEW_SOAK_LINES");
    return text == nullptr ? unless : static_cast<std::size_t>(std::atol(text));
}

void tell(const ModbusRun& run) {
    std::cout << run.executed.count << " lines, " << run.requests << " requests in the last run of "
              << run.restarts << " restarts, " << run.outcome.progress.lost_answers
              << " answers lost in it, " << run.outcome.progress.resent << " lines sent again\n";
}

TEST(ModbusSoak, DropsBeforeAndAfterLateAnswersAndRestartsOverTcp) {
    const std::size_t lines = lines_to_stream(5000);
    ModbusRun run;
    run.set_timeout(30ms);
    run.server.faults = {7, 0.02, 0.02, 0.01, 60ms, 0, static_cast<long>(lines / 4)};
    run.stream(lines, true);
    run.expect_perfect(lines);
    tell(run);
}

TEST(ModbusSoak, DamagedFramesOverAPseudoTerminal) {
    const std::size_t lines = lines_to_stream(2000) / 10 + 500;
    ModbusRun run;
    run.set_timeout(30ms);
    run.server.port = -1;
    run.server.faults = {7, 0.01, 0.01, 0.01, 60ms, 0.02, 0};
    run.stream(lines);
    run.expect_perfect(lines);
    tell(run);
}

}  // namespace
