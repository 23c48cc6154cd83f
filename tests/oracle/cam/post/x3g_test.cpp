// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/convert.h"
#include "cam/post/post_fdm.h"
#include "decomp/base/file.h"
#include "tests/support/stacks.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>

/// What the Creator Pro does in the end: the x3g stream that gpx writes, read back byte by byte.
namespace {

/// Commands of the s3g protocol (MakerBot, s3g/x3g documents) and the bytes that follow each.
enum Command : std::uint8_t {
    kHomeMin = 131,
    kHomeMax = 132,
    kWaitTool = 135,
    kToolAction = 136,
    kSetPosition = 140,
    kWaitPlatform = 141,
    kRecallHome = 144,
    kMessage = 149,
    kProgress = 150,
    kBuildStart = 153,
    kBuildEnd = 154,
    kMove = 155,
};

const std::map<int, std::size_t>& payloads() {
    static const std::map<int, std::size_t> table = {
        {kHomeMin, 7}, {kHomeMax, 7},    {133, 4},       {134, 1},       {kWaitTool, 5},
        {137, 1},      {139, 24},        {142, 25},      {145, 2},       {kSetPosition, 20},
        {146, 5},      {147, 5},         {151, 1},       {156, 1},       {kWaitPlatform, 5},
        {157, 20},     {kRecallHome, 1}, {kProgress, 2}, {kBuildEnd, 1}, {kMove, 31},
    };
    return table;
}

constexpr int kSetNozzle = 3;
constexpr int kSetPlatform = 31;
constexpr double kStepsPerMm[] = {94.117647, 94.117647, 400, 96.2752};

struct Machine {
    bool readable = true;
    int tool_celsius = 0;
    int platform_celsius = 0;
    bool tool_waited = false;
    bool platform_waited = false;
    bool cold_extrusion = false;
    int highest_tool_celsius = 0;
    int highest_platform_celsius = 0;
    double low_mm[3] = {1e9, 1e9, 1e9};
    double high_mm[3] = {-1e9, -1e9, -1e9};
    double filament_mm = 0;
    int moves = 0;
    bool built = false;
};

template <class T>
T at(const std::string& bytes, std::size_t offset) {
    T value{};
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

void act_on_tool(Machine& machine, int action, int value) {
    if (action == kSetNozzle) {
        machine.tool_waited = machine.tool_waited && value != 0;
        machine.tool_celsius = value;
        machine.highest_tool_celsius = std::max(machine.highest_tool_celsius, value);
    } else if (action == kSetPlatform) {
        machine.platform_celsius = value;
        machine.highest_platform_celsius = std::max(machine.highest_platform_celsius, value);
    }
}

void move(Machine& machine, const std::string& bytes, std::size_t payload) {
    const auto relative = at<std::uint8_t>(bytes, payload + 24);
    for (int axis = 0; axis < 3; ++axis) {
        const double mm = at<std::int32_t>(bytes, payload + 4 * static_cast<std::size_t>(axis)) /
                          kStepsPerMm[axis];
        if ((relative & (1 << axis)) == 0 && machine.moves > 1) {
            machine.low_mm[axis] = std::min(machine.low_mm[axis], mm);
            machine.high_mm[axis] = std::max(machine.high_mm[axis], mm);
        }
    }
    const double fed = at<std::int32_t>(bytes, payload + 12) / kStepsPerMm[3];
    EXPECT_NE(relative & 8, 0) << "filament is fed in increments";
    // The tools turn backwards: less is forward.
    machine.filament_mm -= fed;
    if (fed != 0 && !(machine.tool_waited && machine.platform_waited)) {
        machine.cold_extrusion = true;
    }
    ++machine.moves;
}

Machine replay(const std::string& bytes) {
    Machine machine;
    std::size_t offset = 0;
    while (offset < bytes.size()) {
        const int command = static_cast<std::uint8_t>(bytes[offset++]);
        std::size_t length = 0;
        if (command == kToolAction) {
            length = 3 + static_cast<std::uint8_t>(bytes[offset + 2]);
            const int action = static_cast<std::uint8_t>(bytes[offset + 1]);
            act_on_tool(machine, action, length == 5 ? at<std::uint16_t>(bytes, offset + 3) : 0);
        } else if (command == kMessage || command == kBuildStart) {
            const std::size_t text = offset + 4;
            length = 4 + std::strlen(bytes.c_str() + text) + 1;
        } else if (payloads().count(command) != 0) {
            length = payloads().at(command);
        } else {
            machine.readable = false;
            ADD_FAILURE() << "unknown command " << command << " at byte " << offset - 1;
            return machine;
        }
        machine.tool_waited = machine.tool_waited || command == kWaitTool;
        machine.platform_waited = machine.platform_waited || command == kWaitPlatform;
        machine.built = machine.built || command == kBuildEnd;
        if (command == kMove) {
            move(machine, bytes, offset);
        }
        offset += length;
    }
    return machine;
}

TEST(X3g, ThePrinterDoesWhatWasMeant) {
    if (std::system("command -v gpx > /dev/null") != 0) {
        GTEST_SKIP() << "gpx is not installed";
    }
    const tests::TempDir folder;
    const auto setup = cam::profile::read_fdm_setup("flashforge-creator-pro").value();
    const auto program = cam::post::post_fdm(tests::tower(30), setup, {"P01"}, {});
    ASSERT_TRUE(program) << program.error().text();
    ASSERT_TRUE(decomp::write_file(folder / "p.gcode", program->text));
    ASSERT_TRUE(cam::post::convert(folder / "p.gcode", folder / "p.x3g", setup.machine.converter));
    const Machine machine = replay(decomp::read_file(folder / "p.x3g").value());
    ASSERT_TRUE(machine.readable);
    EXPECT_TRUE(machine.built);
    // The bed's temperature went to the bed, the nozzle's to the nozzle; both were waited for and
    // are off at the end.
    EXPECT_EQ(machine.highest_platform_celsius, 60);
    EXPECT_EQ(machine.highest_tool_celsius, 215);
    EXPECT_FALSE(machine.cold_extrusion);
    EXPECT_EQ(machine.tool_celsius, 0);
    EXPECT_EQ(machine.platform_celsius, 0);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(machine.low_mm[axis], setup.machine.chamber.min_mm[axis] - 0.02);
        EXPECT_LE(machine.high_mm[axis], setup.machine.chamber.max_mm[axis] + 0.02);
    }
    constexpr double kPrimeMm = 5;
    EXPECT_NEAR(machine.filament_mm,
                program->estimate.filament_mm + kPrimeMm - setup.machine.retraction.length_mm, 0.1);
    EXPECT_GT(machine.moves, 30 * 100);
}

}  // namespace
