// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/mailbox_bench.h"

namespace {

using namespace std::chrono_literals;
using cam::protocol::Event;
using cam::protocol::JobLines;
using cam::protocol::LineKind;
using cam::protocol::MailboxMap;
using cam::protocol::MailboxOptions;
using cam::protocol::Meeting;
using cam::protocol::Phase;
using cam::protocol::Wish;
using cam::sim::PlcOptions;
using tests::MailboxBench;
using Fate = MailboxBench::Fate;

PlcOptions quick_plc() {
    PlcOptions options;
    options.board.instant = true;
    return options;
}

void begin(MailboxBench& bench) {
    bench.master.allow(bench.job.size(), bench.now);
    bench.master.meet(Meeting::Fresh, bench.now);
}

void expect_perfect(const MailboxBench& bench) {
    EXPECT_EQ(bench.master.phase(), Phase::Finished)
        << (bench.events.empty() ? "" : bench.events.back().code + bench.events.back().text);
    ASSERT_EQ(bench.executed.size(), bench.job.size());
    for (std::size_t i = 0; i < bench.job.size(); ++i) {
        ASSERT_EQ(bench.executed[i], bench.job.text(i)) << i;
    }
}

TEST(Mailbox, EveryLineIsCarriedOutOnceAndInOrder) {
    MailboxBench bench(tests::job_of(3000, tests::mill_line), quick_plc(), {});
    begin(bench);
    bench.run();
    expect_perfect(bench);
    EXPECT_EQ(bench.master.progress().resent, 0);
    EXPECT_LT(bench.exchanges, 500) << "lines travel in batches";
}

TEST(Mailbox, LostRequestsLostAnswersAndStaleOnesChangeNothing) {
    for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
        MailboxOptions options;
        options.timeout = 10ms;
        options.watchdog = 60s;
        PlcOptions plc = quick_plc();
        plc.combined = seed % 2 == 0;
        plc.slots = 2 + static_cast<int>(seed % 3);
        plc.queue_lines = 7 * static_cast<int>(seed);
        plc.slot_regs = 30 + 11 * static_cast<int>(seed);
        MailboxBench bench(tests::job_of(4000, tests::mill_line), plc, options);
        std::mt19937_64 random(seed);
        bench.fate = [&] {
            const auto draw = random() % 100;
            return draw < 10   ? Fate::LostBefore
                   : draw < 20 ? Fate::LostAfter
                   : draw < 25 ? Fate::Stale
                               : Fate::Arrives;
        };
        begin(bench);
        bench.run();
        expect_perfect(bench);
        EXPECT_GT(bench.master.progress().lost_answers, 5);
    }
}

TEST(Mailbox, ADamagedSlotIsNotCarriedOutAndIsWrittenAgain) {
    MailboxOptions options;
    options.timeout = 10ms;
    options.watchdog = 60s;
    MailboxBench bench(tests::job_of(8000, tests::mill_line), quick_plc(), options);
    std::mt19937_64 random(3);
    bench.fate = [&] { return random() % 5 == 0 ? Fate::Damaged : Fate::Arrives; };
    begin(bench);
    bench.run();
    expect_perfect(bench);
    EXPECT_GT(bench.plc.damaged(), 50);
    EXPECT_GT(bench.master.progress().resent, 0);
}

TEST(Mailbox, AQueueShorterThanASlotIsFilledLineByLine) {
    PlcOptions plc = quick_plc();
    plc.queue_lines = 3;
    MailboxBench bench(tests::job_of(200, tests::mill_line), plc, {});
    begin(bench);
    bench.run();
    expect_perfect(bench);
}

TEST(Mailbox, AMachineWithoutFunction23IsSpokenToWithTwo) {
    PlcOptions plc = quick_plc();
    plc.combined = false;
    MailboxBench bench(tests::job_of(300, tests::mill_line), plc, {});
    begin(bench);
    bench.run();
    expect_perfect(bench);
    EXPECT_TRUE(bench.said(Event::Kind::Notice));
}

TEST(Mailbox, ARestartOfThePlcEndsTheJobAndNothingResumesByItself) {
    for (const bool retentive : {false, true}) {
        PlcOptions plc = quick_plc();
        plc.retentive = retentive;
        MailboxBench bench(tests::job_of(2000, tests::mill_line), plc, {});
        begin(bench);
        ASSERT_TRUE(bench.until([&] { return bench.plc.executed() > 500; }));
        bench.plc.restart(bench.now);
        const std::size_t before = bench.executed.size();
        bench.run();
        EXPECT_EQ(bench.master.phase(), Phase::Failed);
        EXPECT_TRUE(bench.said(Event::Kind::Failed, "protocol.machine_reset"))
            << bench.events.back().code;
        EXPECT_EQ(bench.executed.size(), before);
        EXPECT_LE(bench.master.progress().acked, before);
    }
}

TEST(Mailbox, AHoldOvertakesTheQueueWithinOneScanAndOneTransaction) {
    PlcOptions plc;
    plc.board.max_mm_per_s = 20;
    MailboxBench bench(tests::job_of(500, tests::mill_line), plc, {});
    begin(bench);
    ASSERT_TRUE(bench.until([&] { return bench.plc.executed() > 3; }));
    const long before = bench.exchanges;
    bench.master.wish(Wish::Pause, bench.now);
    ASSERT_TRUE(bench.until([&] { return bench.plc.holds(); }));
    EXPECT_LE(bench.exchanges - before, 2) << "that which was on its way, and the hold";
    ASSERT_TRUE(bench.until([&] { return bench.said(Event::Kind::Paused); }));
    const auto at = bench.plc.position(bench.now);
    bench.now += 300ms;
    EXPECT_EQ(bench.plc.position(bench.now), at);
    bench.master.wish(Wish::Resume, bench.now);
    ASSERT_TRUE(bench.until([&] { return bench.master.phase() == Phase::Running; }));
    bench.master.wish(Wish::Stop, bench.now);
    bench.run();
    EXPECT_EQ(bench.master.phase(), Phase::Stopped);
    EXPECT_LT(bench.executed.size(), 500U);
}

TEST(Mailbox, ASilentMasterHoldsTheMachineAndItGoesOnOnlyWhenTold) {
    PlcOptions plc;
    plc.board.max_mm_per_s = 20;
    MailboxOptions options;
    options.timeout = 100ms;
    options.watchdog = 400ms;
    MailboxBench bench(tests::job_of(60, tests::mill_line), plc, options);
    begin(bench);
    ASSERT_TRUE(bench.until([&] { return bench.plc.executed() > 3; }));
    bench.fate = [] { return Fate::LostBefore; };
    ASSERT_TRUE(bench.until([&] { return bench.plc.holds(); }));
    bench.fate = [] { return Fate::Arrives; };
    ASSERT_TRUE(bench.until([&] { return bench.master.phase() == Phase::Paused; }));
    bench.now += 5s;
    bench.plc.scan(bench.now);
    EXPECT_TRUE(bench.plc.holds());
    bench.master.wish(Wish::Resume, bench.now);
    bench.run();
    expect_perfect(bench);
}

TEST(Mailbox, AQuestionIsAskedWhenAllBeforeItIsDoneAndNothingFollowsUntilTheYes) {
    JobLines job = tests::job_of(40, tests::mill_line);
    job.add("G4P0.01", 41, LineKind::Ask);
    job.ask("turned the part?");
    job.expect({39.9, 3, 0, NAN, NAN, NAN});
    job.add("G1X1", 42);
    for (const bool lossy : {false, true}) {
        MailboxOptions options;
        options.watchdog = 60s;
        options.timeout = 10ms;
        MailboxBench bench(job, quick_plc(), options);
        std::mt19937_64 random(5);
        if (lossy) {
            bench.fate = [&] { return random() % 3 == 0 ? Fate::LostAfter : Fate::Arrives; };
        }
        begin(bench);
        ASSERT_TRUE(bench.until([&] { return bench.master.phase() == Phase::Asking; }));
        EXPECT_EQ(bench.executed.size(), 41U);
        for (int i = 0; i < 200; ++i) {
            bench.step();
        }
        EXPECT_EQ(bench.plc.accepted(), 41U);
        bench.master.wish(Wish::Resume, bench.now);
        bench.run();
        expect_perfect(bench);
        EXPECT_EQ(std::count_if(bench.events.begin(), bench.events.end(),
                                [](const Event& one) { return one.kind == Event::Kind::Asked; }),
                  1);
    }
}

TEST(Mailbox, AMachineThatStandsElsewhereThanTheJobStopsIt) {
    JobLines job = tests::job_of(10, tests::mill_line);
    job.add("G4P0.01", 11, LineKind::Drain);
    job.expect({1, 1, 1, NAN, NAN, NAN});
    MailboxBench bench(job, quick_plc(), {});
    begin(bench);
    bench.run();
    EXPECT_TRUE(bench.said(Event::Kind::Failed, "protocol.position_differs"));
}

TEST(Mailbox, AnAlarmABadLineAndSilenceEndTheJob) {
    MailboxBench alarm(tests::job_of(2000, tests::mill_line), quick_plc(), {});
    begin(alarm);
    ASSERT_TRUE(alarm.until([&] { return alarm.plc.executed() > 100; }));
    alarm.plc.alarm(5);
    alarm.run();
    EXPECT_TRUE(alarm.said(Event::Kind::Failed, "protocol.alarm"));
    EXPECT_NE(alarm.events.back().text.find("drive"), std::string::npos);

    MailboxBench mute(tests::job_of(10, tests::mill_line), quick_plc(), {});
    mute.fate = [] { return Fate::LostBefore; };
    begin(mute);
    mute.run();
    EXPECT_TRUE(mute.said(Event::Kind::Failed, "protocol.no_answer"));
}

TEST(Mailbox, NothingLeavesBeforeItIsAllowed) {
    MailboxBench bench(tests::job_of(100, tests::mill_line), quick_plc(), {});
    bench.master.meet(Meeting::Fresh, bench.now);
    for (int i = 0; i < 200; ++i) {
        bench.step();
    }
    EXPECT_EQ(bench.plc.accepted(), 0U);
    bench.master.allow(33, bench.now);
    for (int i = 0; i < 200; ++i) {
        bench.step();
    }
    EXPECT_EQ(bench.plc.accepted(), 33U);
    EXPECT_EQ(bench.master.progress().sent, 33U);
}

TEST(MailboxMap, RegistersMoveAndWhatCannotBeReachedIsRefused) {
    const auto moved = cam::protocol::read_mailbox_map({"slot_area=4096", "x=90"});
    ASSERT_TRUE(moved);
    EXPECT_EQ(cam::protocol::status_span(*moved).count, 76);
    EXPECT_FALSE(cam::protocol::read_mailbox_map({"slots_area=4096"}));
    EXPECT_FALSE(cam::protocol::read_mailbox_map({"x=900"}));
    EXPECT_FALSE(cam::protocol::read_mailbox_map({"x=32"}));
    EXPECT_FALSE(cam::protocol::read_mailbox_map({"command=900"}));
    EXPECT_FALSE(cam::protocol::read_mailbox_map({"x=70000"}));
}

TEST(MailboxMap, TheSumOfASlotIsTheOneOfTheDocument) {
    EXPECT_EQ(cam::protocol::crc32("123456789"), 0xCBF43926U);
    EXPECT_EQ(cam::protocol::crc32("6789", cam::protocol::crc32("12345")), 0xCBF43926U);
    const auto slot =
        cam::protocol::slot_registers(MailboxMap::version_1(), 9, 0x12345678, 7, 2, "G0X1\nM5\n");
    const std::vector<std::uint16_t> head(slot.begin(), slot.begin() + 6);
    EXPECT_EQ(head, (std::vector<std::uint16_t>{9, 0x5678, 0, 7, 0x0102, 8}));
    EXPECT_EQ(slot[8], 'G' * 256 + '0');
}

TEST(ModbusPdu, AnythingMayComeInPiecesAndNothingIsTakenForAnAnswerThatIsNone) {
    std::mt19937_64 random(1);
    for (int round = 0; round < 2000; ++round) {
        cam::protocol::AnswerReader reader;
        for (int piece = 0; piece < 5; ++piece) {
            std::string bytes(random() % 40, '\0');
            for (char& one : bytes) {
                one = static_cast<char>(random() % 4 == 0 ? random() : random() % 4);
            }
            reader.add(bytes);
            while (const auto answer = reader.next()) {
                EXPECT_LE(answer->registers.size(), 128U);
            }
        }
    }
}

}  // namespace
