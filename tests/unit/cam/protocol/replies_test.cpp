// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/grbl_reply.h"
#include "cam/protocol/line_splitter.h"
#include "cam/protocol/marlin_reply.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace cam::protocol;
using Marlin = MarlinReply::Kind;
using Grbl = GrblReply::Kind;

TEST(MarlinReplies, AnAnswerMayCarryNumberAndBuffers) {
    const MarlinReply reply = read_marlin_reply("ok N123 P15 B3");
    EXPECT_EQ(reply.kind, Marlin::Ok);
    EXPECT_EQ(reply.number, 123);
    EXPECT_EQ(reply.planner_free, 15);
    EXPECT_EQ(reply.commands_free, 3);
    EXPECT_EQ(read_marlin_reply("ok 17").number, 17);
}

TEST(MarlinReplies, AnAnswerMayCarryTemperatures) {
    const MarlinReply reply = read_marlin_reply("ok T:201.3 /210.0 B:59.9 /60.0 @:127 B@:0");
    EXPECT_EQ(reply.kind, Marlin::Ok);
    ASSERT_EQ(reply.heaters.size(), 2U);
    EXPECT_EQ(reply.heaters[0].name, "T");
    EXPECT_DOUBLE_EQ(reply.heaters[0].celsius, 201.3);
    EXPECT_DOUBLE_EQ(reply.heaters[1].target_celsius, 60);
}

TEST(MarlinReplies, RequestsOfThreeFirmwaresAreTheSame) {
    for (const char* line :
         {"Resend: 42", "Resend:42", "rs N42 Expected line number 42", "rs 42"}) {
        const MarlinReply reply = read_marlin_reply(line);
        EXPECT_EQ(reply.kind, Marlin::Resend) << line;
        EXPECT_EQ(reply.number, 42) << line;
    }
}

TEST(MarlinReplies, ARequestWithADisturbedNumberHasNone) {
    EXPECT_FALSE(read_marlin_reply("Resend: 4x2").number);
    EXPECT_FALSE(read_marlin_reply("Resend: ").number);
    EXPECT_FALSE(read_marlin_reply("Resend: 99999999999999999999").number);
}

TEST(MarlinReplies, FaultsOfLinesAreToldFromFaultsOfTheMachine) {
    const MarlinReply fault = read_marlin_reply("Error:checksum mismatch, Last Line: 7");
    EXPECT_EQ(fault.kind, Marlin::LineFault);
    EXPECT_EQ(fault.number, 7);
    EXPECT_EQ(read_marlin_reply("Error:Printer halted. kill() called!").kind, Marlin::Fatal);
    EXPECT_EQ(read_marlin_reply("Error:Thermal Runaway, system stopped! Heater_ID: 0").kind,
              Marlin::Fatal);
    EXPECT_EQ(read_marlin_reply("Error:No media").kind, Marlin::Fault);
}

TEST(MarlinReplies, TheAnswerToM115IsTakenApart) {
    const char* line =
        "FIRMWARE_NAME:Marlin 2.0.9 (Apr 1 2021) SOURCE_CODE_URL:github.com/x "
        "MACHINE_TYPE:Ender 3 Pro EXTRUDER_COUNT:1";
    EXPECT_EQ(firmware_field(line, "FIRMWARE_NAME"), "Marlin 2.0.9 (Apr 1 2021)");
    EXPECT_EQ(firmware_field(line, "MACHINE_TYPE"), "Ender 3 Pro");
    EXPECT_EQ(firmware_field(line, "UUID"), "");
}

TEST(MarlinReplies, ThePositionIsReadUpToTheCountOfSteps) {
    const MarlinReply reply = read_marlin_reply("X:1.50 Y:-2.00 Z:0.30 E:7.00 Count X:120 Y:-160");
    ASSERT_TRUE(reply.position_mm);
    EXPECT_DOUBLE_EQ((*reply.position_mm)[1], -2);
    EXPECT_DOUBLE_EQ((*reply.position_mm)[3], 7);
}

TEST(MarlinReplies, LinesAreNumberedAndSummedAsTheFirmwareDoes) {
    EXPECT_EQ(numbered_line(0, "M110 N0"), "N0 M110 N0*125\n");
    EXPECT_EQ(numbered_line(3, "T0"), "N3 T0*57\n");
}

TEST(GrblReplies, AStatusHasAsManyAxesAsTheMachine) {
    const GrblReply reply = read_grbl_reply(
        "<Run|MPos:1.000,2.000,-3.500,90.000|FS:500,8000|WCO:0,0,1,0|Ov:110,100,100>");
    EXPECT_EQ(reply.kind, Grbl::Status);
    EXPECT_EQ(reply.state, "Run");
    EXPECT_EQ(reply.axes, 4);
    EXPECT_DOUBLE_EQ(reply.position[3], 90);
    ASSERT_TRUE(reply.work_offset);
    EXPECT_DOUBLE_EQ((*reply.work_offset)[2], 1);
    EXPECT_DOUBLE_EQ(*reply.feed_override, 1.1);
}

TEST(GrblReplies, WhatNoControllerSaysIsGarbled) {
    for (const char* line :
         {"o*", "okk", "errr:20", "error:2x", "<Rub|MPos:0,0,0>", "<Idle|MPos:0,0,a>",
          "<Idle|MPos:0,0,0", "ALARM:", "hello", "[GC:G0 G54\x01]"}) {
        EXPECT_EQ(read_grbl_reply(line).kind, Grbl::Garbled) << line;
    }
}

TEST(GrblReplies, FactsAboutTheControllerAreRead) {
    EXPECT_EQ(read_grbl_reply("Grbl 1.1h ['$' for help]").kind, Grbl::Banner);
    EXPECT_EQ(read_grbl_reply("GrblHAL 1.1f ['$' or '$HELP' for help]").kind, Grbl::Banner);
    EXPECT_EQ(read_grbl_reply("[AXS:4:XYZA]").text, "XYZA");
    EXPECT_EQ(read_grbl_reply("[OPT:V,15,128]").text, "V,15,128");
    const GrblReply offset = read_grbl_reply("[G55:1.000,-2.000,3.000]");
    EXPECT_EQ(offset.kind, Grbl::Offset);
    EXPECT_EQ(offset.text, "G55");
    EXPECT_DOUBLE_EQ(offset.values[1], -2);
    const GrblReply setting = read_grbl_reply("$130=300.000");
    EXPECT_EQ(setting.number, 130);
    EXPECT_DOUBLE_EQ(setting.values[0], 300);
}

TEST(GrblReplies, EveryNumberHasWords) {
    for (int number = -1; number < 60; ++number) {
        EXPECT_GT(grbl_error_words(number).size(), 12U) << number;
        EXPECT_GT(grbl_alarm_words(number).size(), 12U) << number;
    }
}

TEST(Replies, FiguresThatNoMachineHasAreNone) {
    for (const char* figure : {"nan", "inf", "-inf", "1e300", "99999999999", "9890E12"}) {
        const std::string value(figure);
        const std::string place = "X:" + value + " Y:1.00 Z:2.00 E:0.00 Count X:0 Y:0 Z:0";
        const MarlinReply position = read_marlin_reply(place);
        if (position.position_mm) {
            const double x = (*position.position_mm)[0];
            EXPECT_TRUE(std::isnan(x) || std::abs(x) <= 1e7) << figure;
        }
        for (const Heater& heater : read_marlin_reply("T:" + value + " /" + value).heaters) {
            EXPECT_LE(std::abs(heater.celsius), 1e7) << figure;
            EXPECT_LE(std::abs(heater.target_celsius), 1e7) << figure;
        }
        EXPECT_EQ(read_grbl_reply("<Idle|MPos:" + value + ",0.000,0.000|FS:0,0>").kind,
                  GrblReply::Kind::Garbled)
            << figure;
    }
}

TEST(LineSplitter, CutsAtEveryEndAndDropsEmptyLines) {
    LineSplitter splitter;
    std::string_view bytes = "ok\r\n\nsta";
    ASSERT_TRUE(splitter.next(bytes));
    EXPECT_EQ(splitter.line(), "ok");
    EXPECT_FALSE(splitter.next(bytes));
    bytes = "rt\n";
    ASSERT_TRUE(splitter.next(bytes));
    EXPECT_EQ(splitter.line(), "start");
}

TEST(LineSplitter, ALineWithoutAnEndTakesNoMoreThanItsBound) {
    LineSplitter splitter;
    const std::string flood(1 << 20, 'x');
    std::string_view bytes = flood;
    ASSERT_TRUE(splitter.next(bytes));
    EXPECT_TRUE(splitter.cut());
    EXPECT_EQ(splitter.line().size(), LineSplitter::kLongest);
    EXPECT_FALSE(splitter.next(bytes));
    bytes = "rest\nok\n";
    ASSERT_TRUE(splitter.next(bytes));
    EXPECT_EQ(splitter.line(), "ok");
}

}  // namespace
