// SPDX-License-Identifier: GPL-3.0-or-later
// Independent peers: Debian's printcore prints to our virtual Marlin, over a line with faults.
#include "cam/sim/marlin_board.h"
#include "cam/sim/virtual_machine.h"
#include "tests/support/run_program.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

namespace {

TEST(Printcore, PrintsEveryLineToTheVirtualMarlin) {
    if (!std::filesystem::exists("/usr/bin/printcore")) {
        GTEST_SKIP() << "printcore is not installed (Debian package printcore)";
    }
    const tests::TempDir folder;
    std::string program;
    std::vector<std::string> wanted;
    for (int i = 0; i < 200; ++i) {
        wanted.push_back("G1 X" + std::to_string(i % 150) + " Y" + std::to_string(i * 3 % 100) +
                         " F6000");
        program += wanted.back() + "\n";
    }
    ASSERT_TRUE(decomp::write_file(folder / "job.gcode", program));
    cam::sim::BoardOptions board_options;
    board_options.instant = true;
    auto board = std::make_unique<cam::sim::MarlinBoard>(board_options);
    const cam::sim::MarlinBoard* marlin = board.get();
    std::vector<std::string> executed;
    board->on_executed = [&](std::string_view text) { executed.emplace_back(text); };
    cam::sim::VirtualMachine::Options options;
    options.faults.flip_line_out = 0.02;
    options.banner = false;
    cam::sim::VirtualMachine machine(std::move(board), options);
    ASSERT_TRUE(machine.start());
    const auto run = tests::run_program(
        {"/usr/bin/printcore", "-b", "115200", machine.port(), folder / "job.gcode"});
    machine.stop();
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
    std::erase_if(executed, [](const std::string& text) { return !text.starts_with("G1"); });
    EXPECT_EQ(executed, wanted);
    EXPECT_GT(marlin->refused(), 0);
}

}  // namespace
