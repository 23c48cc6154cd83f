// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/arc.h"
#include "cam/sim/faults.h"
#include "cam/sim/grbl_board.h"
#include "cam/sim/log_replay.h"
#include "cam/sim/marlin_board.h"
#include "cam/sim/wire.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace cam::sim;
using namespace std::chrono_literals;

std::string say(Board& board, std::string_view text, Time now) {
    board.receive(text, now);
    board.advance(now);
    return board.take_output();
}

TEST(MarlinBoard, RefusesWrongSumsAndNumbersAndNamesItsLastLine) {
    MarlinBoard board({});
    board.reset(Time{});
    (void)board.take_output();
    EXPECT_EQ(say(board, "N0 M110 N0*125\n", Time{}), "ok\n");
    EXPECT_EQ(say(board, "N1 G90*17\n", Time{}), "ok\n");
    EXPECT_EQ(say(board, "N2 G90*19\n", Time{}),
              "Error:checksum mismatch, Last Line: 1\nResend: 2\nok\n");
    EXPECT_EQ(say(board, "N5 G90*21\n", Time{}),
              "Error:Line Number is not Last Line Number+1, Last Line: 1\nResend: 2\nok\n");
    EXPECT_EQ(say(board, "N2 G90\n", Time{}),
              "Error:No Checksum with line number, Last Line: 1\nResend: 2\nok\n");
}

TEST(MarlinBoard, AnEBehindANumberIsTheExtruderAndNoExponent) {
    BoardOptions options;
    options.instant = true;
    MarlinBoard board(options);
    board.reset(Time{});
    (void)say(board, "G1X1Y9.5E2F3000\n", Time{});
    EXPECT_DOUBLE_EQ(board.position(Time{})[1], 9.5);
    EXPECT_DOUBLE_EQ(board.position(Time{})[3], 2);
}

TEST(MarlinBoard, MovesTakeTheirTimeAndTheSeventeenthWaits) {
    MarlinBoard board({});
    board.reset(Time{});
    (void)board.take_output();
    int answers = 0;
    for (int i = 1; i <= 17; ++i) {
        answers +=
            say(board, "G1 X" + std::to_string(10 * i) + " F6000\n", Time{}) == "ok\n" ? 1 : 0;
    }
    EXPECT_EQ(answers, 16);
    // 10 mm at 100 mm/s from rest to rest at 1000 mm/s2: 0.2 s.
    ASSERT_TRUE(board.next());
    EXPECT_EQ(*board.next(), 200ms);
    board.advance(200ms);
    EXPECT_EQ(board.take_output(), "ok\n");
    EXPECT_NEAR(board.position(300ms)[0], 15, 0.01);
}

TEST(MarlinBoard, TheBufferRunsOverWhileTheQueueIsFull) {
    MarlinBoard board({});
    board.reset(Time{});
    board.receive("M109 S200\n", Time{});
    board.advance(Time{});
    for (int i = 0; i < 30; ++i) {
        board.receive("G1 X1 Y1\n", Time{});
    }
    EXPECT_GT(board.overflowed(), 50U);
}

TEST(MarlinBoard, TheEmergencyParserSeesAStopBehindAFullQueue) {
    MarlinBoard board({});
    board.reset(Time{});
    for (int i = 0; i < 20; ++i) {
        board.receive("G28\n", Time{});
    }
    board.advance(Time{});
    (void)board.take_output();
    EXPECT_NE(say(board, "\nM112\n", Time{}).find("halted"), std::string::npos);
    EXPECT_TRUE(board.halted());
    EXPECT_EQ(say(board, "G1 X1\n", Time{}), "");
}

TEST(GrblBoard, AnswersErrorsByTheirNumbers) {
    GrblBoard board({});
    board.reset(Time{});
    (void)board.take_output();
    EXPECT_EQ(say(board, "G1X1\n", Time{}), "error:22\r\n");
    EXPECT_EQ(say(board, "M6T1\n", Time{}), "error:20\r\n");
    EXPECT_EQ(say(board, "G1X1Y\n", Time{}), "error:2\r\n");
    EXPECT_EQ(say(board, "G1X1A5F100\n", Time{}), "error:20\r\n");
    EXPECT_EQ(say(board, "G2X1Y1F100\n", Time{}), "error:35\r\n");
    EXPECT_EQ(say(board, "G1X1F100\n", Time{}), "ok\r\n");
    EXPECT_EQ(say(board, "$Q\n", Time{}), "error:3\r\n");
}

TEST(GrblBoard, HoldsReportsAndLosesItsPositionOnAResetInMotion) {
    GrblBoard board({});
    board.reset(Time{});
    (void)board.take_output();
    say(board, "G1X50F600\n", Time{});
    board.advance(1ms);
    EXPECT_EQ(say(board, "!", 1s), "");
    EXPECT_EQ(say(board, "?", 3s).substr(0, 7), "<Hold:0");
    say(board, "~", 3s);
    EXPECT_EQ(say(board, "?", 3s).substr(0, 4), "<Run");
    const std::string reset = say(board, "\x18", 4s);
    EXPECT_NE(reset.find("ALARM:3"), std::string::npos);
    EXPECT_NE(reset.find("Grbl 1.1"), std::string::npos);
    EXPECT_EQ(say(board, "G0X1\n", 4s), "error:9\r\n");
}

TEST(GrblBoard, LosesBytesBeyondItsBuffer) {
    GrblBoard board({});
    board.reset(Time{});
    say(board, "G1X1000F60\n", Time{});
    for (int i = 0; i < 60; ++i) {
        say(board, "G1X" + std::to_string(i) + "Y1.234\n", Time{});
    }
    EXPECT_GT(board.overflowed(), 0U);
    EXPECT_EQ(board.fullest(), 127U);
}

TEST(GrblBoard, TheCheckModeMovesNothingAndEndsInAReset) {
    GrblBoard board({});
    board.reset(Time{});
    (void)board.take_output();
    EXPECT_EQ(say(board, "$C\n", Time{}), "[MSG:Enabled]\r\nok\r\n");
    EXPECT_EQ(say(board, "G1X10F100\n", Time{}), "ok\r\n");
    EXPECT_FALSE(board.next());
    EXPECT_EQ(say(board, "$C\n", Time{}),
              "[MSG:Disabled]\r\nok\r\n\r\nGrbl 1.1h ['$' for help]\r\n");
}

TEST(Wire, BytesTakeTheirTimeAtTheBaudRate) {
    Wire wire({}, 1000);
    wire.from_host("abc", Time{});
    EXPECT_EQ(wire.to_board(9ms), "");
    EXPECT_EQ(wire.to_board(10ms), "a");
    EXPECT_EQ(wire.to_board(30ms), "bc");
}

TEST(Wire, FaultsComeAtTheirRatesAndAgainWithTheSameSeed) {
    Faults faults;
    faults.flip_line_out = 0.1;
    faults.drop_ack = 0.05;
    std::vector<std::string> seen;
    for (int pass = 0; pass < 2; ++pass) {
        Wire wire(faults, 0);
        std::string out;
        for (int i = 0; i < 10000; ++i) {
            wire.from_host("N1 G1 X1*34\n", Time{});
            out += wire.to_board(Time{});
            wire.from_board("ok\n", Time{});
            out += wire.to_host(Time{});
        }
        EXPECT_NEAR(static_cast<double>(wire.flipped_lines()), 1000, 120);
        EXPECT_NEAR(static_cast<double>(wire.lost_acks()), 500, 90);
        seen.push_back(out);
    }
    EXPECT_EQ(seen[0], seen[1]);
}

TEST(Faults, AScriptIsReadAndAMistakeNamed) {
    const auto faults = read_faults(
        "seed 7\nflip line 0.01 both # noise\ndrop ack 0.02\ndelay ack 0.001 40ms\n"
        "unplug every 10000 for 2s\nreset at 500\n");
    ASSERT_TRUE(faults) << faults.error();
    EXPECT_EQ(faults->seed, 7U);
    EXPECT_DOUBLE_EQ(faults->flip_line_in, 0.01);
    EXPECT_EQ(faults->delay, 40ms);
    EXPECT_EQ(faults->unplugged, 2s);
    EXPECT_EQ(faults->reset_at, std::vector<long>{500});
    EXPECT_NE(read_faults("seed 1\nflip everything\n").error().find("line 2"), std::string::npos);
    EXPECT_FALSE(read_faults("drop ack 1.5\n"));
}

TEST(LogReplay, GivesTheAnswersOfTheLog) {
    auto replay = LogReplay::read("100 > M105\\n\n250 < ok T:20\\n\n300 > G28\\n\n900 < ok\\n\n");
    ASSERT_TRUE(replay) << replay.error();
    LogReplay& board = **replay;
    board.reset(Time{});
    EXPECT_EQ(say(board, "M105\n", 1ms), "");
    board.advance(1ms + 150us);
    EXPECT_EQ(board.take_output(), "ok T:20\n");
    say(board, "G29\n", 2ms);
    EXPECT_EQ(board.differs_at(), 7U);
    board.advance(3ms);
    EXPECT_EQ(board.take_output(), "ok\n");
    EXPECT_TRUE(board.done());
    EXPECT_FALSE(LogReplay::read("nonsense\n"));
}

TEST(Arc, IsAsLongAsItsFormulaSays) {
    const auto length = [](const cam::sim::Arc& arc) {
        double sum = 0;
        cam::sim::Point last = arc.from;
        for (const cam::sim::Point& point : cam::sim::arc_points(arc, 0.002)) {
            sum += std::hypot(point[0] - last[0], point[1] - last[1], point[2] - last[2]);
            EXPECT_NEAR(std::hypot(point[0], point[1]), 10, 1e-9);
            last = point;
        }
        EXPECT_EQ(last, arc.to);
        return sum;
    };
    const cam::sim::Point east{10, 0, 0};
    const cam::sim::Point north{0, 10, 0};
    const double turn = 2 * 3.14159265358979 * 10;
    EXPECT_NEAR(length({east, north, 0, 1, 0, 0, false}), turn / 4, 0.01);
    EXPECT_NEAR(length({east, north, 0, 1, 0, 0, true}), turn * 3 / 4, 0.02);
    EXPECT_NEAR(length({east, east, 0, 1, 0, 0, true}), turn, 0.02);
    EXPECT_NEAR(length({east, {10, 0, 7}, 0, 1, 0, 0, false}), std::hypot(turn, 7), 0.02);
}

TEST(Arc, ByRadiusTakesTheShorterWayUnlessTheRadiusIsNegative) {
    for (const bool clockwise : {false, true}) {
        cam::sim::Arc arc{{10, 0}, {0, 10}, 0, 1, 0, 0, clockwise};
        ASSERT_TRUE(cam::sim::centre_of(arc, 10));
        EXPECT_NEAR(arc.centre_u, clockwise ? 10 : 0, 1e-9);
        EXPECT_NEAR(arc.centre_v, clockwise ? 10 : 0, 1e-9);
        ASSERT_TRUE(cam::sim::centre_of(arc, -10));
        EXPECT_NEAR(arc.centre_u, clockwise ? 0 : 10, 1e-9);
        EXPECT_FALSE(cam::sim::centre_of(arc, 5));
    }
}

}  // namespace
