// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/grbl_board.h"
#include "cam/sim/marlin_board.h"
#include "cam/sim/virtual_machine.h"
#include "cam/stream/resume.h"
#include "decomp/base/rng.h"
#include "tests/cli/hew.h"

#include <cstdlib>
#include <fstream>

namespace {

using tests::hew;
using tests::Json;

/// A virtual printer whose carried-out commands are kept.
struct Printer {
    std::vector<std::string> executed;
    cam::sim::MarlinBoard* board = nullptr;
    std::unique_ptr<cam::sim::VirtualMachine> machine;

    explicit Printer(const std::string& link) {
        cam::sim::BoardOptions options;
        options.instant = true;
        auto own = std::make_unique<cam::sim::MarlinBoard>(options);
        own->on_executed = [this](std::string_view text) { executed.emplace_back(text); };
        board = own.get();
        machine = std::make_unique<cam::sim::VirtualMachine>(
            std::move(own), cam::sim::VirtualMachine::Options{0, {}, link, true});
        EXPECT_TRUE(machine->start());
    }

    /// Entries of the job that the board has.
    long has() {
        long last = 0;
        machine->visit([&](cam::sim::Board&, cam::sim::Wire&, cam::sim::Time) {
            last = board->last_number();
        });
        return last >= 10000 ? last - 10000 : 0;
    }
};

std::vector<std::string> moves(int count) {
    std::vector<std::string> out;
    for (int i = 0; i < count; ++i) {
        out.push_back("G1X" + std::to_string(i % 200) + "Y" + std::to_string(i * 7 % 150) + "Z" +
                      std::to_string(1 + i % 9) + "F3000");
    }
    return out;
}

std::string write_program(const tests::TempDir& folder, const std::vector<std::string>& lines) {
    std::ofstream out(folder / "job.gcode");
    for (const std::string& line : lines) {
        out << line << "\n";
    }
    return folder / "job.gcode";
}

TEST(Stream, APlateOfAJobIsPrintedOnAVirtualPrinter) {
    const tests::TempDir folder;
    const std::string model = tests::write_stl(folder, "block.stl", tests::block(12, 12, 2));
    ASSERT_EQ(hew(tests::quick_make(model, folder / "out")).exit_code, 0);
    Printer printer(folder / "port");
    const auto run = hew({"stream", folder / "out", "--link", "virtual-marlin", "--port",
                          folder / "port", "--events", folder / "events", "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const Json answer = tests::object_of(run);
    EXPECT_EQ(answer["phase"], "finished");
    EXPECT_EQ(answer["lines"]["acked"], answer["lines"]["total"]);
    printer.machine->stop();
    EXPECT_EQ(printer.executed.size() + 1,
              answer["lines"]["total"]);  // M114 is no command of the job
    EXPECT_NE(decomp::read_file(folder / "events")->find("\"event\":\"finished\""),
              std::string::npos);
}

TEST(Stream, AProgramWithoutProofAStrangeMachineAndACardAreRefused) {
    const tests::TempDir folder;
    const std::string program = write_program(folder, moves(5));
    const auto code = [&](std::vector<std::string> more) {
        const auto run = hew(tests::with({"stream", program, "--json"}, more));
        return tests::object_of(run)["error"]["code"].get<std::string>();
    };
    EXPECT_EQ(code({"--machine", "prusa-mk3s", "--port", "nowhere"}), "stream.no_proof");
    EXPECT_EQ(code({"--machine", "flashforge-creator-pro", "--foreign"}), "stream.card_only");
    EXPECT_EQ(code({"--machine", "prusa-mk3s", "--foreign", "--port", "nowhere"}),
              "transport.not_found");
    Printer printer(folder / "port");
    EXPECT_EQ(code({"--machine", "prusa-mk3s", "--foreign", "--port", folder / "port", "--set",
                    "link.reset_on_open=false"}),
              "stream.identity");
    EXPECT_TRUE(printer.executed.empty());
}

/// HEW_KILLS says how often; the journal's last record is torn half of the time.
TEST(Stream, KilledAnywhereItKnowsWhereItStoodAndGoesOnExactlyThere) {
    const char* wish = std::getenv("HEW_KILLS");
    const int kills = wish == nullptr ? 6 : std::atoi(wish);
    const tests::TempDir folder;
    const std::vector<std::string> lines = moves(30000);
    const std::string program = write_program(folder, lines);
    decomp::Rng rng(11);
    int killed = 0;
    for (int job = 0; killed < kills && job < 1000; ++job) {
        Printer printer(folder / "port");
        const std::vector<std::string> begin = {
            "stream",    program, "--machine", "prusa-mk3s",    "--link", "virtual-marlin",
            "--foreign", "--yes", "--port",    folder / "port", "-q"};
        const std::string journal = program + ".journal";
        std::filesystem::remove(journal);
        bool begun = false;
        bool finished = false;
        while (!finished) {
            const bool last = killed >= kills;
            const std::vector<std::string> words = begun ? tests::with(begin, {"--resume"}) : begin;
            const auto run =
                last ? hew(words)
                     : hew(words,
                           tests::Kill{SIGKILL, std::chrono::milliseconds(30 + rng.below(300))});
            finished = run.exit_code == 0;
            if (run.signal != SIGKILL) {
                ASSERT_TRUE(finished) << run.err;
                break;
            }
            ++killed;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            const long truth = printer.has();
            if (!std::filesystem::exists(journal)) {
                ASSERT_EQ(truth, 0);
                continue;
            }
            if (rng.below(2) == 0) {
                std::ofstream(journal, std::ios::app) << "0badc0de 77 at 99999";
            }
            const auto contents = cam::journal::read_journal(journal);
            const auto standing = cam::stream::read_standing(*contents);
            if (!standing) {
                ASSERT_EQ(truth, 0);
                std::filesystem::remove(journal);
                continue;
            }
            begun = truth > 0;
            if (!begun) {
                std::filesystem::remove(journal);
                continue;
            }
            ASSERT_LE(static_cast<long>(standing->acked), truth);
            ASSERT_GE(static_cast<long>(standing->allowed), truth);
        }
        printer.machine->stop();
        std::erase_if(printer.executed,
                      [](const std::string& text) { return !text.starts_with("G1"); });
        ASSERT_EQ(printer.executed.size(), lines.size());
        EXPECT_TRUE(printer.executed == lines);
    }
    std::printf("%d kills\n", killed);
}

TEST(Stream, AResetMachineIsBroughtBackIntoTheStateOfTheJob) {
    const tests::TempDir folder;
    std::vector<std::string> lines = {"G21", "G90", "M83", "M140S60", "M104S205", "G28"};
    for (const std::string& line : moves(500)) {
        lines.push_back(line);
    }
    const std::string program = write_program(folder, lines);
    std::ofstream(folder / "faults") << "reset at 300\n";
    std::vector<std::string> words = {"stream", program,          "--machine", "prusa-mk3s",
                                      "--link", "virtual-marlin", "--foreign", "--yes",
                                      "--port", folder / "port",  "--json"};
    {
        cam::sim::BoardOptions options;
        options.instant = true;
        cam::sim::VirtualMachine::Options machine_options;
        machine_options.faults.reset_at = {300};
        machine_options.link = folder / "port";
        cam::sim::VirtualMachine machine(std::make_unique<cam::sim::MarlinBoard>(options),
                                         machine_options);
        ASSERT_TRUE(machine.start());
        EXPECT_EQ(tests::object_of(hew(words))["error"]["code"], "protocol.machine_reset");
    }
    Printer printer(folder / "port");
    EXPECT_EQ(tests::object_of(hew(tests::with(words, {"--resume"})))["error"]["code"],
              "protocol.machine_reset");
    EXPECT_TRUE(printer.executed.empty());
    const auto run = hew(tests::with(words, {"--resume", "--after-reset"}));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    printer.machine->stop();
    const auto has = [&](const std::string& text) {
        return std::find(printer.executed.begin(), printer.executed.end(), text) !=
               printer.executed.end();
    };
    EXPECT_TRUE(has("M190S60"));
    EXPECT_TRUE(has("M109S205"));
    EXPECT_TRUE(has("M83"));
    EXPECT_EQ(printer.executed[printer.executed.size() - 2], lines.back());
}

/// A virtual mill that needs time for its motion.
struct Mill {
    std::vector<std::string> executed;
    cam::sim::GrblBoard* board = nullptr;
    std::unique_ptr<cam::sim::VirtualMachine> machine;

    explicit Mill(const std::string& link, bool locked = false) {
        cam::sim::BoardOptions options;
        options.speed = 10;
        options.homing = locked;
        auto own = std::make_unique<cam::sim::GrblBoard>(options);
        own->on_executed = [this](std::string_view text) { executed.emplace_back(text); };
        board = own.get();
        machine = std::make_unique<cam::sim::VirtualMachine>(
            std::move(own), cam::sim::VirtualMachine::Options{0, {}, link, true});
        EXPECT_TRUE(machine->start());
    }

    std::size_t has() {
        std::size_t out = 0;
        machine->visit(
            [&](cam::sim::Board&, cam::sim::Wire&, cam::sim::Time) { out = executed.size(); });
        return out;
    }
};

TEST(Stream, AMillThatKeptItsPowerGoesOnWithTheLineOnWhichItStands) {
    const tests::TempDir folder;
    std::vector<std::string> lines = {"G21G90G17", "M3S8000", "G0X0Y0Z0", "G1Z-1F600"};
    for (int i = 1; i < 120; ++i) {
        lines.push_back("G1X" + std::to_string(i) + "Y" + std::to_string(i % 2 * 10) + "F2000");
    }
    lines.emplace_back("G0Z0");
    const std::string program = write_program(folder, lines);
    Mill mill(folder / "port");
    const std::vector<std::string> words = {"stream", program,         "--machine", "genmitsu-3018",
                                            "--link", "virtual-grbl",  "--foreign", "--yes",
                                            "--port", folder / "port", "--allow",   "unknown_code"};
    const auto killed = hew(words, tests::Kill{SIGKILL, std::chrono::milliseconds(1500)});
    ASSERT_EQ(killed.signal, SIGKILL) << killed.err;
    const auto early = hew(tests::with(words, {"--resume", "--json"}));
    if (early.exit_code != 0) {  // it still works off what it has: where it ends up is not known
        EXPECT_EQ(tests::object_of(early)["error"]["code"], "stream.machine_busy");
    }
    // As a person would: again, until it stands.
    std::size_t before = 0;
    auto run = early;
    for (int i = 0; i < 100 && (i == 0 || run.err.find("machine_busy") != std::string::npos); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        before = mill.has();
        run = hew(tests::with(words, {"--resume"}));
    }
    ASSERT_GT(before, 20U);
    ASSERT_LT(before, lines.size());
    const std::string last = mill.executed[before - 1];
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("on the way of line"), std::string::npos) << run.err;
    mill.machine->stop();
    // The line that it was on comes again, then all others: no more and no fewer.
    const auto again =
        std::find(mill.executed.begin() + static_cast<long>(before), mill.executed.end(), last);
    const auto in_program = std::find(lines.begin(), lines.end(), last);
    ASSERT_NE(again, mill.executed.end()) << last;
    const std::vector<std::string> rest(in_program, lines.end());
    ASSERT_GE(mill.executed.end() - again, static_cast<long>(rest.size()));
    EXPECT_TRUE(std::equal(rest.begin(), rest.end(), again));
    EXPECT_NE(std::find(mill.executed.begin() + static_cast<long>(before), again, "M3S8000"),
              again);
}

TEST(Stream, AProvedMillingProgramRunsAndAChangedOneIsRefused) {
    const tests::TempDir folder;
    const std::string model = tests::write_stl(folder, "plate.stl", tests::block(12, 10, 4));
    const std::string program = (folder / "p.nc").string();
    const auto milled = hew({"mill", model, "--machine", "genmitsu-3018", "--tools",
                             "flat-6,ball-3", "--scallop", "0.1", "-o", program, "-q"});
    ASSERT_EQ(milled.exit_code, 0) << milled.out << milled.err;
    Mill mill(folder / "port");
    const std::vector<std::string> words = {
        "stream", program,  "--machine",     "genmitsu-3018", "--link", "virtual-grbl",
        "--yes",  "--port", folder / "port", "--dry-run",     "--json"};
    const auto judged = hew(words);
    EXPECT_EQ(judged.exit_code, 0) << judged.out << judged.err;
    std::string text = *decomp::read_file(program);
    text.insert(text.find("\nG1") + 1, "G1 Z-9\n");
    ASSERT_TRUE(decomp::write_file(program, text, decomp::Overwrite::Allow));
    const auto changed = hew(words);
    EXPECT_NE(changed.exit_code, 0);
    EXPECT_EQ(tests::object_of(changed)["error"]["code"], "proof.stale") << changed.out;
}

TEST(Stream, ALockedMillIsHomedAfterAYes) {
    const tests::TempDir folder;
    const std::string program = write_program(folder, {"G21G90", "G0X1Y1Z-1", "G1X5F600"});
    Mill mill(folder / "port", true);
    const std::vector<std::string> words = {
        "stream",       program,     "--machine", "genmitsu-3018", "--link",
        "virtual-grbl", "--foreign", "--port",    folder / "port", "--json"};
    // Nobody is there to say yes.
    EXPECT_EQ(tests::object_of(hew(words))["phase"], "stopped");
    EXPECT_TRUE(mill.executed.empty());
    const auto run = hew(tests::with(words, {"--yes"}));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    // With --json what happens is told on stderr, an object a line.
    EXPECT_NE(run.err.find("{\"event\":\"asked\""), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("{\"event\":\"finished\""), std::string::npos) << run.err;
}

}  // namespace
