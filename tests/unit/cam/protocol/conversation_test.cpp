// SPDX-License-Identifier: GPL-3.0-or-later
// The state machines alone: bytes and times in, bytes and events out.
#include "cam/protocol/grbl.h"
#include "cam/protocol/marlin.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace {

using namespace cam::protocol;
using namespace std::chrono_literals;

JobLines three_moves() {
    JobLines job;
    for (const char* line : {"G1X1F600", "G1X2", "G1X3"}) {
        job.add(line, static_cast<long>(job.size()) + 1);
    }
    return job;
}

LinkOptions at_once() {
    LinkOptions options;
    options.expects_banner = false;
    options.silence = 1s;
    options.precheck = false;
    return options;
}

std::string bytes_of(Protocol& conversation) {
    const Output out = conversation.take_output();
    return out.urgent + out.bytes;
}

struct MarlinAtWork : testing::Test {
    JobLines job = three_moves();
    Marlin conversation{job, at_once()};
    Instant now{};
    bool reports = true;

    std::string hear(const char* text) {
        conversation.receive(text, now);
        return bytes_of(conversation);
    }

    void SetUp() override {
        conversation.meet(Meeting::Fresh, now);
        hear("ok\n");
        hear("FIRMWARE_NAME:Marlin 2 MACHINE_TYPE:Test EXTRUDER_COUNT:1\n");
        if (reports) {
            hear("Cap:AUTOREPORT_TEMP:1\nok\n");
        }
        hear("ok\n");
        hear("ok\n");
        hear("Error:Line Number is not Last Line Number+1, Last Line: 10000\nResend: 10001\nok\n");
        ASSERT_EQ(conversation.phase(), Phase::Ready);
        conversation.allow(job.size(), now);
        conversation.run(0, now);
        ASSERT_EQ(bytes_of(conversation), numbered_line(10001, "G1X1F600"));
    }
};

/// A board that tells its temperatures only when it is asked.
struct MarlinWithoutReports : MarlinAtWork {
    MarlinWithoutReports() { reports = false; }
};

TEST_F(MarlinAtWork, SendsTheNextLineOnlyWhenTheLastIsAnsweredFor) {
    EXPECT_EQ(hear("T:20.0 /0.0\n"), "");
    EXPECT_EQ(hear("ok\n"), numbered_line(10002, "G1X2"));
    EXPECT_EQ(hear("ok\n"), numbered_line(10003, "G1X3"));
    EXPECT_EQ(hear("ok\n"), "");
    EXPECT_EQ(conversation.phase(), Phase::Finished);
}

TEST_F(MarlinAtWork, SendsARefusedLineAgainAndSwallowsTheAnswerToTheRefusal) {
    hear("ok\n");
    EXPECT_EQ(hear("Error:checksum mismatch, Last Line: 10001\nResend: 10002\nok\n"),
              numbered_line(10002, "G1X2"));
    EXPECT_EQ(conversation.progress().acked, 1U);
    EXPECT_EQ(conversation.progress().resent, 1);
}

TEST_F(MarlinAtWork, AsksWhereTheBoardIsInsteadOfGuessingAfterASilence) {
    now += 1500ms;
    conversation.tick(now);
    EXPECT_EQ(bytes_of(conversation), "\n" + numbered_line(9999, "M105"));
    // It has the line: only the answer was lost.
    EXPECT_EQ(
        hear("Error:Line Number is not Last Line Number+1, Last Line: 10001\nResend: 10002\nok\n"),
        numbered_line(10002, "G1X2"));
    EXPECT_EQ(conversation.progress().lost_answers, 1);
    EXPECT_EQ(conversation.progress().resent, 0);
}

TEST_F(MarlinAtWork, ASilentBoardThatIsBusyIsNotAsked) {
    now += 900ms;
    hear("echo:busy: processing\n");
    now += 900ms;
    conversation.tick(now);
    EXPECT_EQ(bytes_of(conversation), "");
}

TEST_F(MarlinAtWork, DisturbedRequestsAreNotFollowed) {
    hear("ok\n");
    // Number and last line contradict each other: the board is asked again.
    EXPECT_EQ(hear("Error:checksum mismatch, Last Line: 10001\nResend: 10003\nok\n"),
              "\n" + numbered_line(9999, "M105"));
    // Far outside of what is under way, again and again: not our board any more.
    for (int i = 0; i < 3; ++i) {
        hear("Resend: 34497\nok\n");
    }
    EXPECT_EQ(conversation.phase(), Phase::Failed);
}

TEST_F(MarlinAtWork, ABoardWhoseLastLineIsNoneWasReset) {
    now += 1500ms;
    conversation.tick(now);
    (void)conversation.take_output();
    for (int i = 0; i < 3; ++i) {
        conversation.receive(
            "Error:Line Number is not Last Line Number+1, Last Line: 0\nResend: 1\nok\n", now);
    }
    EXPECT_EQ(conversation.phase(), Phase::Failed);
    EXPECT_EQ(conversation.take_output().events.back().code, "protocol.machine_reset");
}

/// Whatever byte of it is disturbed, a query is no command of its own: it is refused, or unknown.
TEST_F(MarlinAtWork, AQueryWithAnotherFirstLetterIsNoKnownCommand) {
    now += 1500ms;
    conversation.tick(now);
    std::string query = bytes_of(conversation);
    for (const char letter : {'G', 'M', 'T'}) {
        query[1] = letter;
        EXPECT_GE(std::atol(query.c_str() + 2), 9990) << query;
    }
}

TEST_F(MarlinAtWork, AStopGoesAheadOfEverythingAndSaysThatItMayWait) {
    conversation.wish(Wish::Stop, now);
    const Output out = conversation.take_output();
    EXPECT_TRUE(out.discard);
    EXPECT_EQ(out.urgent, "\nM112\n");
    ASSERT_EQ(out.events.size(), 1U);
    EXPECT_EQ(out.events[0].kind, Event::Kind::Warning);
    hear("Error:Printer halted. kill() called!\n");
    EXPECT_EQ(conversation.phase(), Phase::Stopped);
}

TEST_F(MarlinAtWork, ACancelledJobTurnsTheHeatersOff) {
    conversation.wish(Wish::Cancel, now);
    EXPECT_EQ(bytes_of(conversation), "");
    EXPECT_EQ(hear("ok\n"), numbered_line(10002, "M104 S0"));
    EXPECT_EQ(hear("ok\n"), numbered_line(10003, "M140 S0"));
    EXPECT_EQ(hear("ok\n"), numbered_line(10004, "M107"));
    hear("ok\n");
    EXPECT_EQ(conversation.phase(), Phase::Stopped);
}

TEST_F(MarlinAtWork, ThePauseKeepsLinesBackAndTheMachineMayAskForOne) {
    hear("//action:pause\n");
    EXPECT_EQ(conversation.phase(), Phase::Paused);
    EXPECT_EQ(hear("ok\n"), "");
    EXPECT_EQ(hear("//action:resume\n"), numbered_line(10002, "G1X2"));
}

TEST_F(MarlinAtWork, TheFeedIsChangedBetweenLinesAndReadBack) {
    conversation.wish(Wish::FeedUp, now);
    conversation.wish(Wish::FeedUp, now);
    EXPECT_EQ(bytes_of(conversation), "");  // a line of the job is on its way
    EXPECT_EQ(hear("ok\n"), "M220 S120\n");
    EXPECT_EQ(hear("ok\n"), "M220\n");
    EXPECT_EQ(hear("FR:120%\nok\n"), numbered_line(10002, "G1X2"));
    EXPECT_DOUBLE_EQ(conversation.status().feed_override, 1.2);
    EXPECT_EQ(conversation.progress().acked, 1U);
}

TEST_F(MarlinAtWork, AFeedThatTheMachineDoesNotTellIsAskedForThreeTimesAndThenSaid) {
    conversation.wish(Wish::FeedDown, now);
    hear("ok\n");
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(hear("ok\n"), "M220\n");
        EXPECT_EQ(hear("FR:100%\nok\n"), "M220 S90\n");
    }
    hear("ok\n");
    conversation.receive("FR:100%\nok\n", now);
    const Output out = conversation.take_output();
    ASSERT_FALSE(out.events.empty());
    EXPECT_EQ(out.events.back().kind, Event::Kind::Warning);
    EXPECT_EQ(out.bytes, numbered_line(10002, "G1X2"));
}

TEST_F(MarlinAtWork, ALostAnswerBesideTheJobIsFoundOutByTheQuery) {
    conversation.wish(Wish::FeedUp, now);
    hear("ok\n");
    now += 1500ms;
    conversation.tick(now);
    EXPECT_EQ(bytes_of(conversation), "\n" + numbered_line(9999, "M105"));
    EXPECT_EQ(
        hear("Error:Line Number is not Last Line Number+1, Last Line: 10001\nResend: 10002\nok\n"),
        "M220\n");
    EXPECT_EQ(hear("FR:110%\nok\n"), numbered_line(10002, "G1X2"));
}

TEST_F(MarlinWithoutReports, TemperaturesAreAskedForWhereTheyAreNotReported) {
    conversation.tick(now);
    EXPECT_EQ(bytes_of(conversation), "");
    EXPECT_EQ(hear("ok\n"), "M105\n");
    EXPECT_EQ(hear("ok T:200.0 /210.0 B:60.0 /60.0\n"), numbered_line(10002, "G1X2"));
    ASSERT_EQ(conversation.status().heaters.size(), 2U);
    EXPECT_EQ(conversation.progress().acked, 1U);
    EXPECT_EQ(hear("ok\n"), numbered_line(10003, "G1X3"));
}

TEST_F(MarlinWithoutReports, ALateTemperatureIsNotTakenForABoardThatWasReset) {
    conversation.tick(now);
    (void)bytes_of(conversation);
    EXPECT_EQ(hear("ok\n"), "M105\n");
    now += 1500ms;
    conversation.tick(now);
    EXPECT_EQ(bytes_of(conversation), "\n" + numbered_line(9999, "M105"));
    hear("ok T:200.0 /210.0\n");
    EXPECT_EQ(conversation.phase(), Phase::Running);
    EXPECT_EQ(
        hear("Error:Line Number is not Last Line Number+1, Last Line: 10001\nResend: 10002\nok\n"),
        numbered_line(10002, "G1X2"));
}

TEST_F(MarlinAtWork, AQuestionOfTheMachineIsAnsweredWithTheChosenAnswer) {
    conversation.receive(
        "//action:prompt_begin Filament runout\n//action:prompt_button Purge more\n"
        "//action:prompt_button Continue\n//action:prompt_show\n",
        now);
    const Output asked = conversation.take_output();
    ASSERT_EQ(asked.events.size(), 1U);
    EXPECT_EQ(asked.events[0].text, "Filament runout");
    EXPECT_EQ(asked.events[0].choices, (std::vector<std::string>{"Purge more", "Continue"}));
    conversation.wish(choice(2), now);  // there is no third
    EXPECT_EQ(bytes_of(conversation), "");
    conversation.wish(choice(1), now);
    EXPECT_EQ(bytes_of(conversation), "\nM876 S1\n");
    conversation.wish(choice(1), now);  // it has been answered
    EXPECT_EQ(bytes_of(conversation), "");
}

TEST_F(MarlinAtWork, TheEndOfTheJobComparesThePosition) {
    for (const char* place : {"X:3.00 Y:0.00 Z:0.00 E:0.00 Count X:240 Y:0 Z:0\n",
                              "X:2.50 Y:0.00 Z:0.00 E:0.00 Count X:200 Y:0 Z:0\n", ""}) {
        JobLines with_end = three_moves();
        with_end.add("M114", 0, LineKind::Drain);
        AxisValues expected{};
        expected.fill(std::numeric_limits<double>::quiet_NaN());
        expected[0] = 3;
        with_end.expect(expected);
        Marlin one(with_end, at_once());
        one.meet(Meeting::Fresh, now);
        for (const char* said :
             {"ok\n", "FIRMWARE_NAME:Marlin 2\nCap:AUTOREPORT_TEMP:1\nok\n", "ok\n", "ok\n",
              "Error:Line Number is not Last Line Number+1, Last Line: 10000\nResend: "
              "10001\nok\n"}) {
            one.receive(said, now);
        }
        one.allow(4, now);
        one.run(0, now);
        one.receive("ok\nok\nok\n", now);
        (void)one.take_output();
        one.receive(std::string(place) + "ok\n", now);
        const Output out = one.take_output();
        EXPECT_EQ(one.phase(), Phase::Finished);
        const bool right = std::string(place).starts_with("X:3");
        ASSERT_EQ(out.events.size(), right ? 1U : 2U) << place;
        if (!right) {
            EXPECT_EQ(out.events[0].kind, Event::Kind::Warning);
        }
    }
}

TEST_F(MarlinAtWork, MoreThanTenRequestsForOneLinePause) {
    for (int i = 0; i < 11; ++i) {
        hear("Error:checksum mismatch, Last Line: 10000\nResend: 10001\nok\n");
    }
    EXPECT_EQ(conversation.phase(), Phase::Paused);
}

TEST_F(MarlinAtWork, NothingLeavesThatIsNotAllowed) {
    JobLines again = three_moves();
    Marlin held(again, at_once());
    held.meet(Meeting::Again, now);
    held.receive("FIRMWARE_NAME:Marlin 2\nok\n", now);
    (void)held.take_output();
    held.receive(
        "Error:Line Number is not Last Line Number+1, Last Line: 10002\nResend: 10003\nok\n", now);
    const Output ready = held.take_output();
    ASSERT_FALSE(ready.events.empty());
    EXPECT_EQ(ready.events.back().kind, Event::Kind::Ready);
    EXPECT_EQ(ready.events.back().line, 2);
    held.run(2, now);
    EXPECT_EQ(bytes_of(held), "");
    held.allow(3, now);
    EXPECT_EQ(bytes_of(held), numbered_line(10003, "G1X3"));
}

TEST_F(MarlinAtWork, ReportsAreAskedForWithNumbersAndSums) {
    Marlin one(job, at_once());
    one.meet(Meeting::Fresh, now);
    one.receive("ok\nFIRMWARE_NAME:Marlin 2\nCap:AUTOREPORT_TEMP:1\nCap:AUTOREPORT_POS:1\nok\n",
                now);
    one.receive("ok\nok\n", now);
    const std::string said = bytes_of(one);
    EXPECT_NE(said.find(numbered_line(9992, "M155 S1") + numbered_line(9993, "M154 S1")),
              std::string::npos)
        << said;
}

TEST_F(MarlinAtWork, ADisturbedLastLineIsAskedForOnceMore) {
    hear("ok\n");
    conversation.lose_link(now);
    conversation.meet(Meeting::Again, now);
    (void)conversation.take_output();
    // The request says 10001, the error 10002: one of them was disturbed.
    hear("Error:Line Number is not Last Line Number+1, Last Line: 10002\nResend: 10001\nok\n");
    EXPECT_EQ(conversation.phase(), Phase::Meeting);
    now += 60ms;
    conversation.tick(now);
    EXPECT_EQ(bytes_of(conversation), "\n" + numbered_line(9999, "M105"));
    conversation.receive(
        "Error:Line Number is not Last Line Number+1, Last Line: 10002\nResend: 10003\nok\n", now);
    EXPECT_EQ(conversation.phase(), Phase::Ready);
    EXPECT_EQ(conversation.take_output().events.back().line, 2);
}

TEST_F(MarlinAtWork, AJobWhoseLinesTheBoardHasAllIsFinishedWhenTheLinkIsBack) {
    hear("ok\nok\n");
    conversation.lose_link(now);
    conversation.meet(Meeting::Again, now);
    hear("Error:Line Number is not Last Line Number+1, Last Line: 10003\nResend: 10004\nok\n");
    conversation.run(3, now);
    EXPECT_EQ(conversation.phase(), Phase::Finished);
}

TEST_F(MarlinAtWork, AKnownBoardIsOnlyAskedForItsLastLineAfterTheLinkWasLost) {
    hear("ok\n");
    conversation.lose_link(now);
    conversation.meet(Meeting::Again, now);
    EXPECT_EQ(bytes_of(conversation), "\n" + numbered_line(9999, "M105"));
    conversation.receive(
        "Error:Line Number is not Last Line Number+1, Last Line: 10002\nResend: 10003\nok\n", now);
    const Output out = conversation.take_output();
    ASSERT_FALSE(out.events.empty());
    EXPECT_EQ(out.events.back().kind, Event::Kind::Ready);
    EXPECT_EQ(out.events.back().line, 2);
    EXPECT_EQ(conversation.identity().machine, "Test");
}

struct GrblAtWork : testing::Test {
    JobLines job = three_moves();
    LinkOptions options = at_once();
    Instant now{};

    static std::string hear(Grbl& conversation, const char* text, Instant now) {
        conversation.receive(text, now);
        return bytes_of(conversation);
    }

    void meet(Grbl& conversation) const {
        conversation.meet(Meeting::Fresh, now);
        hear(conversation, "<Idle|MPos:0,0,0|WCO:0,0,0>\n", now);
        hear(conversation, "[VER:1.1h.20190830:]\n[OPT:V,15,20]\nok\n", now);
        hear(conversation, "$13=0\n$22=0\nok\n", now);
        hear(conversation, "[G54:0,0,0]\nok\n", now);
        hear(conversation, "<Idle|MPos:0,0,0|WCO:0,0,0>\n", now);
        ASSERT_EQ(conversation.phase(), Phase::Ready);
        conversation.allow(3, now);
    }
};

TEST_F(GrblAtWork, FillsTheBufferButForOneByte) {
    Grbl conversation(job, options);
    meet(conversation);
    conversation.run(0, now);
    // 20 bytes told: 9 + 5 + 5 = 19 fit.
    EXPECT_EQ(bytes_of(conversation), "G1X1F600\nG1X2\nG1X3\n");
    hear(conversation, "ok\nok\nok\n", now);
    EXPECT_EQ(conversation.phase(), Phase::Finished);
}

TEST_F(GrblAtWork, AnErrorHoldsAtOnceAndResetsWhenItStands) {
    Grbl conversation(job, options);
    meet(conversation);
    conversation.run(0, now);
    (void)conversation.take_output();
    conversation.receive("ok\nerror:20\n", now);
    const Output out = conversation.take_output();
    EXPECT_TRUE(out.discard);
    EXPECT_EQ(out.urgent.front(), '!');
    EXPECT_EQ(hear(conversation, "<Hold:0|MPos:0,0,0|WCO:0,0,0>\n", now), "\x18");
    EXPECT_EQ(conversation.phase(), Phase::Failed);
}

TEST_F(GrblAtWork, AnAnswerThatNobodyGivesHoldsAtOnce) {
    for (const char* garbage : {"o~k\n", "\x80\x81\n", "ok\nok\nok\nok\n"}) {
        Grbl conversation(job, options);
        meet(conversation);
        job.add("G1X4", 4);
        conversation.run(0, now);
        (void)conversation.take_output();
        conversation.receive(garbage, now);
        EXPECT_EQ(conversation.take_output().urgent.substr(0, 1), "!") << garbage;
        job = three_moves();
    }
}

TEST_F(GrblAtWork, ABannerInTheMiddleMeansThatThePositionIsLost) {
    Grbl conversation(job, options);
    meet(conversation);
    conversation.run(0, now);
    (void)conversation.take_output();
    conversation.receive("\r\nGrbl 1.1h ['$' for help]\r\n", now);
    EXPECT_EQ(conversation.phase(), Phase::Failed);
    EXPECT_EQ(conversation.take_output().events.back().code, "protocol.machine_reset");
}

TEST_F(GrblAtWork, AlarmsAreToldInWords) {
    Grbl conversation(job, options);
    meet(conversation);
    conversation.run(0, now);
    (void)conversation.take_output();
    conversation.receive("ALARM:1\n", now);
    const Output out = conversation.take_output();
    ASSERT_FALSE(out.events.empty());
    EXPECT_EQ(out.events.back().code, "protocol.alarm");
    EXPECT_NE(out.events.back().text.find("limit switch"), std::string::npos);
}

TEST_F(GrblAtWork, TheWholeJobIsReadInCheckModeBeforeAnythingMoves) {
    options.precheck = true;
    Grbl conversation(job, options);
    meet(conversation);
    conversation.run(0, now);
    EXPECT_EQ(bytes_of(conversation), "$C\n");
    EXPECT_EQ(hear(conversation, "[MSG:Enabled]\nok\n", now), "G1X1F600\nG1X2\nG1X3\n");
    hear(conversation, "ok\nerror:22\n", now);
    EXPECT_EQ(conversation.phase(), Phase::Failed);
}

TEST_F(GrblAtWork, APositionThatDiffersAtASyncPointStops) {
    job.add("G4P0.01", 0, LineKind::Drain);
    AxisValues expected{};
    expected.fill(std::numeric_limits<double>::quiet_NaN());
    expected[0] = 3;
    job.expect(expected);
    job.add("G1X5", 5);
    Grbl conversation(job, options);
    meet(conversation);
    conversation.run(0, now);
    EXPECT_EQ(bytes_of(conversation), "G1X1F600\nG1X2\nG1X3\n");
    conversation.allow(5, now);
    EXPECT_EQ(hear(conversation, "ok\nok\nok\n", now), "G4P0.01\n");
    EXPECT_EQ(hear(conversation, "ok\n", now), "?");
    conversation.receive("<Idle|MPos:3.500,0,0|WCO:0,0,0>\n", now);
    EXPECT_EQ(conversation.take_output().urgent.front(), '!');
    EXPECT_EQ(conversation.phase(), Phase::Stopping);
}

TEST_F(GrblAtWork, AnswersToLinesOfAnEarlierProgramHoldNothing) {
    Grbl conversation(job, options);
    meet(conversation);
    EXPECT_EQ(hear(conversation, "ok\nok\nerror:20\n", now), "");
    EXPECT_EQ(conversation.phase(), Phase::Ready);
}

TEST_F(GrblAtWork, ALockedMachineIsHomedWhenTheOperatorWantsIt) {
    Grbl conversation(job, options);
    conversation.meet(Meeting::Fresh, now);
    hear(conversation, "<Alarm|MPos:0,0,0|WCO:0,0,0>\n", now);
    hear(conversation, "[VER:1.1h.20190830:]\n[OPT:V,15,20]\nok\n", now);
    hear(conversation, "$13=0\n$22=1\nok\n", now);
    hear(conversation, "[G54:0,0,0]\nok\n", now);
    conversation.receive("<Alarm|MPos:0,0,0|WCO:0,0,0>\n", now);
    const Output asked = conversation.take_output();
    ASSERT_EQ(asked.events.size(), 1U);
    EXPECT_EQ(asked.events[0].kind, Event::Kind::Asked);
    EXPECT_EQ(asked.bytes, "");
    // Reports of the alarm are no news meanwhile.
    hear(conversation, "<Alarm|MPos:0,0,0>\n", now);
    ASSERT_EQ(conversation.phase(), Phase::Asking);
    conversation.wish(Wish::Resume, now);
    EXPECT_EQ(bytes_of(conversation), "$H\n");
    now += 60s;  // homing takes its time, and says nothing
    conversation.tick(now);
    EXPECT_EQ(bytes_of(conversation), "");
    EXPECT_EQ(hear(conversation, "ok\n", now), "?");
    hear(conversation, "<Idle|MPos:0,0,0|WCO:0,0,0>\n", now);
    hear(conversation, "[OPT:V,15,20]\nok\n", now);
    hear(conversation, "$22=1\nok\n", now);
    hear(conversation, "[G54:0,0,0]\nok\n", now);
    hear(conversation, "<Idle|MPos:0,0,0>\n", now);
    EXPECT_EQ(conversation.phase(), Phase::Ready);
    EXPECT_TRUE(conversation.identity().homed);
}

TEST_F(GrblAtWork, AHomingThatFailsEndsTheJobBeforeItBegins) {
    for (const char* answer : {"error:5\n", "ALARM:9\n"}) {
        Grbl conversation(job, options);
        conversation.meet(Meeting::Fresh, now);
        hear(conversation, "<Alarm|MPos:0,0,0|WCO:0,0,0>\n", now);
        hear(conversation, "ok\n", now);
        hear(conversation, "$22=1\nok\n", now);
        hear(conversation, "ok\n", now);
        hear(conversation, "<Alarm|MPos:0,0,0>\n", now);
        conversation.wish(Wish::Resume, now);
        (void)conversation.take_output();
        conversation.receive(answer, now);
        const Output out = conversation.take_output();
        ASSERT_FALSE(out.events.empty()) << answer;
        EXPECT_EQ(out.events.back().code, "protocol.homing_failed");
    }
}

TEST_F(GrblAtWork, APauseAlwaysReachesTheMachineWhateverALateReportSaid) {
    Grbl conversation(job, options);
    meet(conversation);
    conversation.run(0, now);
    conversation.wish(Wish::Pause, now);
    now += 1s;
    conversation.wish(Wish::Resume, now);
    (void)conversation.take_output();
    hear(conversation, "<Hold:0|MPos:0,0,0>\n", now);  // was under way
    EXPECT_EQ(conversation.phase(), Phase::Running);
    conversation.wish(Wish::Pause, now);
    conversation.wish(Wish::Pause, now);
    EXPECT_EQ(conversation.take_output().urgent, "!!");
}

TEST_F(GrblAtWork, PauseAndOverridesAreBytesOutsideTheCount) {
    Grbl conversation(job, options);
    meet(conversation);
    conversation.run(0, now);
    (void)conversation.take_output();
    conversation.wish(Wish::Pause, now);
    EXPECT_EQ(conversation.take_output().urgent, "!");
    conversation.wish(Wish::FeedUp, now);
    EXPECT_EQ(conversation.take_output().urgent, "\x91");
    conversation.wish(Wish::Resume, now);
    EXPECT_EQ(conversation.take_output().urgent, "~");
}

}  // namespace
