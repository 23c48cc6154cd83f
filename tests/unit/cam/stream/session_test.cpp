// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/streaming.h"
#include "tests/support/temp_dir.h"

namespace {

using namespace std::chrono_literals;
using cam::protocol::Event;
using cam::protocol::Phase;
using cam::protocol::Wish;
using cam::sim::BoardOptions;
using cam::sim::Faults;
using cam::sim::GrblBoard;
using cam::sim::MarlinBoard;
using cam::sim::VirtualMachine;
using cam::stream::Notice;
using cam::stream::Session;
using tests::Executed;

constexpr std::size_t kLines = 2000;

struct MarlinRun {
    Executed executed;
    cam::stream::Outcome outcome;
    long refused = 0;

    void stream(const Faults& faults, cam::protocol::LinkOptions link, BoardOptions board_options,
                std::size_t lines, const std::string& terminal_link = {}) {
        board_options.instant = true;
        auto board = std::make_unique<MarlinBoard>(board_options);
        MarlinBoard* marlin = board.get();
        executed.wanted = tests::move_line;
        board->on_executed = [this](std::string_view text) { executed.take(text); };
        VirtualMachine::Options options;
        options.faults = faults;
        options.link = terminal_link;
        VirtualMachine machine(std::move(board), options);
        ASSERT_TRUE(machine.start());
        const cam::protocol::JobLines job = tests::job_of(lines, tests::move_line);
        cam::protocol::Marlin conversation(job, link);
        Session::Options session_options;
        session_options.asks_to_continue = false;
        Session session(conversation, tests::opener(machine), session_options);
        const auto ended = session.run();
        machine.stop();
        ASSERT_TRUE(ended) << ended.error().text();
        outcome = *ended;
        refused = marlin->refused();
    }

    void expect_perfect(std::size_t lines) const {
        EXPECT_EQ(outcome.phase, Phase::Finished) << outcome.code << ": " << outcome.text;
        EXPECT_EQ(executed.count, lines);
        EXPECT_EQ(executed.changed, 0U) << executed.first_difference;
        EXPECT_EQ(executed.added, 0U) << executed.first_difference;
        EXPECT_EQ(executed.lost, 0U) << executed.first_difference;
    }
};

TEST(MarlinSession, EveryLineIsCarriedOutOnceAndInOrder) {
    MarlinRun run;
    run.stream({}, tests::quick_link(), {}, kLines);
    run.expect_perfect(kLines);
    EXPECT_EQ(run.outcome.progress.resent, 0);
    EXPECT_EQ(run.refused, 1);  // the query that confirms the line number
}

TEST(MarlinSession, FlippedBytesLostDoubledAndLateAnswersLoseNothing) {
    Faults faults;
    faults.flip_line_out = 0.02;
    faults.flip_line_in = 0.01;
    faults.drop_ack = 0.01;
    faults.double_ack = 0.002;
    faults.delay_ack = 0.002;
    faults.delay = 30ms;
    cam::protocol::LinkOptions link = tests::quick_link();
    link.silence = 10ms;
    link.max_resend_fraction = 1;
    MarlinRun run;
    run.stream(faults, link, {}, kLines);
    run.expect_perfect(kLines);
    EXPECT_GT(run.outcome.progress.resent, 0);
    EXPECT_GT(run.outcome.progress.lost_answers, 0);
}

TEST(MarlinSession, APulledCableIsPluggedInAgainAndNothingIsLost) {
    const tests::TempDir folder;
    Faults faults;
    faults.unplug_every = 500;
    faults.unplugged = 20ms;
    MarlinRun run;
    run.stream(faults, tests::quick_link(), {}, kLines, folder / "port");
    run.expect_perfect(kLines);
}

TEST(MarlinSession, AWindowOfFourConvergesWithNumberedAnswers) {
    Faults faults;
    faults.flip_line_out = 0.02;
    cam::protocol::LinkOptions link = tests::quick_link();
    link.window = 4;
    link.silence = 20ms;
    link.max_resend_fraction = 1;
    BoardOptions board;
    board.advanced_ok = true;
    MarlinRun run;
    run.stream(faults, link, board, 500);
    run.expect_perfect(500);
}

TEST(MarlinSession, AResetInTheMiddleEndsTheJob) {
    Faults faults;
    faults.reset_at = {700};
    MarlinRun run;
    run.stream(faults, tests::quick_link(), {}, kLines);
    EXPECT_EQ(run.outcome.phase, Phase::Failed);
    EXPECT_EQ(run.outcome.code, "protocol.machine_reset");
    EXPECT_LT(run.executed.count, 720U);
}

struct GrblRun {
    Executed executed;
    cam::stream::Outcome outcome;
    std::size_t overflowed = 0;
    std::size_t fullest = 0;

    void stream(const Faults& faults, const cam::protocol::LinkOptions& link, std::size_t lines,
                long baud = 0) {
        BoardOptions board_options;
        board_options.instant = true;
        auto board = std::make_unique<GrblBoard>(board_options);
        GrblBoard* grbl = board.get();
        executed.wanted = tests::mill_line;
        board->on_executed = [this](std::string_view text) { executed.take(text); };
        VirtualMachine::Options options;
        options.faults = faults;
        options.baud = baud;
        VirtualMachine machine(std::move(board), options);
        ASSERT_TRUE(machine.start());
        const cam::protocol::JobLines job = tests::job_of(lines, tests::mill_line);
        cam::protocol::Grbl conversation(job, link);
        Session session(conversation, tests::opener(machine), {});
        const auto ended = session.run();
        machine.stop();
        ASSERT_TRUE(ended) << ended.error().text();
        outcome = *ended;
        overflowed = grbl->overflowed();
        fullest = grbl->fullest();
    }
};

TEST(GrblSession, EveryLineIsCarriedOutOnceAndTheBufferNeverRunsOver) {
    GrblRun run;
    run.stream({}, tests::quick_link(), kLines);
    EXPECT_EQ(run.outcome.phase, Phase::Finished) << run.outcome.code << ": " << run.outcome.text;
    EXPECT_EQ(run.executed.count, kLines);
    EXPECT_EQ(run.executed.changed, 0U) << run.executed.first_difference;
    EXPECT_EQ(run.overflowed, 0U);
    EXPECT_LE(run.fullest, 127U);
}

TEST(GrblSession, TheJobIsReadInCheckModeFirst) {
    cam::protocol::LinkOptions link = tests::quick_link();
    link.precheck = true;
    GrblRun run;
    run.stream({}, link, 200);
    EXPECT_EQ(run.outcome.phase, Phase::Finished) << run.outcome.code << ": " << run.outcome.text;
    EXPECT_EQ(run.executed.count, 200U);
}

}  // namespace
