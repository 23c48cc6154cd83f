// SPDX-License-Identifier: GPL-3.0-or-later
// What happens when somebody or something stops a session, in time.
#include "tests/support/streaming.h"
#include "tests/support/temp_dir.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace {

using namespace std::chrono_literals;
using cam::protocol::Phase;
using cam::protocol::Wish;
using cam::stream::Session;

double seconds_of_cpu() {
    rusage usage{};
    ::getrusage(RUSAGE_THREAD, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) / 1e6;
}

/// A mill that works on long moves.
struct SlowMill {
    cam::sim::GrblBoard* board = nullptr;
    std::unique_ptr<cam::sim::VirtualMachine> machine;
    cam::protocol::JobLines job;
    cam::protocol::LinkOptions link = tests::quick_link();

    explicit SlowMill(const cam::sim::Faults& faults = {}) {
        auto own = std::make_unique<cam::sim::GrblBoard>(cam::sim::BoardOptions{});
        board = own.get();
        machine = std::make_unique<cam::sim::VirtualMachine>(
            std::move(own), cam::sim::VirtualMachine::Options{0, faults, {}, true});
        EXPECT_TRUE(machine->start());
        for (int i = 0; i < 400; ++i) {
            job.add("G1X" + std::to_string(i % 2 * 20) + "Y" + std::to_string(i % 50) + "F3000",
                    i + 1);
        }
    }

    bool moving() {
        bool out = false;
        machine->visit(
            [&](cam::sim::Board&, cam::sim::Wire&, cam::sim::Time) { out = board->moving(); });
        return out;
    }
};

TEST(Stop, ReachesTheWireAtOnceAndTheMillStandsWithinATenthOfASecond) {
    SlowMill mill;
    cam::protocol::Grbl conversation(mill.job, mill.link);
    const tests::TempDir folder;
    auto log = cam::stream::RawLog::open(folder / "raw.log");
    ASSERT_TRUE(log);
    Session::Options options;
    options.log = log->get();
    Session session(conversation, tests::opener(*mill.machine), options);
    std::atomic<bool> done{false};
    cam::stream::Outcome outcome;
    std::thread carrier([&] {
        outcome = session.run().value_or(cam::stream::Outcome{});
        done = true;
    });
    while (!mill.moving()) {
        std::this_thread::sleep_for(5ms);
    }
    const auto asked = std::chrono::steady_clock::now();
    session.post(Wish::Stop);
    while (mill.moving()) {
        std::this_thread::sleep_for(1ms);
    }
    const auto stood = std::chrono::steady_clock::now();
    carrier.join();
    EXPECT_LT(stood - asked, 500ms);  // a tenth on an idle computer
    EXPECT_EQ(outcome.phase, Phase::Stopped) << outcome.text;
}

TEST(Stop, AnErrorAmongLinesInTheBufferHoldsTheFeed) {
    SlowMill mill;
    mill.job = {};
    for (int i = 0; i < 100; ++i) {
        mill.job.add(i == 40 ? "M6T1" : "G1X" + std::to_string(i % 2 * 5) + "F3000", i + 1);
    }
    cam::protocol::Grbl conversation(mill.job, mill.link);
    Session session(conversation, tests::opener(*mill.machine), {});
    const auto outcome = session.run();
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->code, "protocol.machine_error");
    EXPECT_NE(outcome->text.find("line 41"), std::string::npos) << outcome->text;
    std::this_thread::sleep_for(50ms);
    EXPECT_FALSE(mill.moving());
}

TEST(Stop, DisturbedAnswersHoldTheFeed) {
    cam::sim::Faults faults;
    faults.flip_line_in = 0.03;
    SlowMill mill(faults);
    cam::protocol::Grbl conversation(mill.job, mill.link);
    Session session(conversation, tests::opener(*mill.machine), {});
    const auto outcome = session.run();
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->phase, Phase::Failed);
    std::this_thread::sleep_for(50ms);
    EXPECT_FALSE(mill.moving());
}

TEST(Idle, APausedJobUsesHardlyAnyProcessor) {
    SlowMill mill;
    mill.link.poll = 250ms;
    cam::protocol::Grbl conversation(mill.job, mill.link);
    Session session(conversation, tests::opener(*mill.machine), {});
    double used = 1;
    std::thread carrier([&] {
        const double before = seconds_of_cpu();
        (void)session.run();
        used = seconds_of_cpu() - before;
    });
    while (!mill.moving()) {
        std::this_thread::sleep_for(5ms);
    }
    session.post(Wish::Pause);
    std::this_thread::sleep_for(1500ms);
    session.post(Wish::Stop);
    carrier.join();
    EXPECT_LT(used / 1.5, 0.01);
}

TEST(Pace, CharacterCountingKeepsASlowLineFull) {
    const std::size_t lines = 400;
    cam::sim::BoardOptions board_options;
    board_options.instant = true;
    cam::sim::VirtualMachine machine(std::make_unique<cam::sim::GrblBoard>(board_options),
                                     {115200, {}, {}, true});
    ASSERT_TRUE(machine.start());
    const cam::protocol::JobLines job = tests::job_of(lines, tests::mill_line);
    cam::protocol::Grbl conversation(job, tests::quick_link());
    Session session(conversation, tests::opener(machine), {});
    const auto before = std::chrono::steady_clock::now();
    const auto outcome = session.run();
    ASSERT_TRUE(outcome);
    ASSERT_EQ(outcome->phase, Phase::Finished) << outcome->text;
    const double taken =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    const double least = static_cast<double>(job.wire_bytes()) * 10 / 115200;
    RecordProperty("fraction_of_line_rate", std::to_string(least / taken));
    std::printf("%.3f of the line rate\n", least / taken);
    EXPECT_GT(least / taken, 0.5);  // 0.95 on an idle computer
}

TEST(Log, OfASessionCanBeReplayed) {
    const tests::TempDir folder;
    const cam::protocol::JobLines job = tests::job_of(50, tests::move_line);
    {
        cam::sim::BoardOptions board_options;
        board_options.instant = true;
        cam::sim::VirtualMachine machine(std::make_unique<cam::sim::MarlinBoard>(board_options),
                                         {0, {}, {}, false});
        ASSERT_TRUE(machine.start());
        auto log = cam::stream::RawLog::open(folder / "raw.log");
        cam::protocol::Marlin conversation(job, tests::quick_link());
        Session::Options options;
        options.log = log->get();
        Session session(conversation, tests::opener(machine), options);
        ASSERT_EQ(session.run()->phase, Phase::Finished);
    }
    auto replay = cam::sim::LogReplay::read(*decomp::read_file(folder / "raw.log"));
    ASSERT_TRUE(replay) << replay.error();
    cam::sim::LogReplay* board = replay->get();
    cam::sim::VirtualMachine machine(std::move(*replay), {0, {}, {}, true});
    ASSERT_TRUE(machine.start());
    cam::protocol::Marlin conversation(job, tests::quick_link());
    Session session(conversation, tests::opener(machine), {});
    EXPECT_EQ(session.run()->phase, Phase::Finished);
    machine.stop();
    EXPECT_TRUE(board->done());
    EXPECT_EQ(board->differs_at(), std::string::npos);
}

}  // namespace
