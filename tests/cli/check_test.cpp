// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/hew.h"
#include "tests/support/part_shapes.h"

#include <algorithm>

namespace {

namespace fs = std::filesystem;
using tests::contents;
using tests::hew;
using tests::Json;
using tests::object_of;
using tests::write_stl;

std::string dome(const tests::TempDir& dir) {
    return write_stl(dir, "dome.stl", tests::half_sphere(15, 48, 24));
}

TEST(Check, ADomeNeedsNoSupportAndIsAHeightField) {
    const tests::TempDir dir;
    const auto printed =
        hew({"check", dome(dir), "--process", "fdm", "--machine", "prusa-mk3s", "--json"});
    ASSERT_EQ(printed.exit_code, 0) << printed.err;
    const Json fdm = object_of(printed);
    EXPECT_EQ(fdm["parts"][0]["3DPPS"]["paper_percent"], 0);
    EXPECT_EQ(fdm["parts"][0]["fits"], true);
    EXPECT_EQ(fdm["whole"]["axes"].size(), 6U);
    const auto milled = hew({"check", dome(dir), "--process", "mill3", "--json"});
    ASSERT_EQ(milled.exit_code, 0) << milled.err;
    const Json mill = object_of(milled);
    EXPECT_EQ(mill["parts"][0]["height_field"], true);
    EXPECT_EQ(mill["parts"][0]["3AM"]["true_percent"], 0);
}

TEST(Check, WhatCannotBeMadeEndsInFour) {
    const tests::TempDir dir;
    const std::string ball = write_stl(dir, "ball.stl", tests::sphere(15, 48, 25));
    EXPECT_EQ(hew({"check", ball, "--process", "mill3"}).exit_code, 4);
    EXPECT_EQ(hew({"check", ball, "--process", "mill3", "--setups", "2"}).exit_code, 0);
    EXPECT_EQ(hew({"check", ball, "--process", "mill4"}).exit_code, 0);
    const auto large = hew({"check", ball, "--process", "mill4", "--height", "300mm", "--machine",
                            "linuxcnc-router-4axis", "--set", "reach.cell_mm=2", "--set",
                            "reach.tolerance_mm=2", "--json"});
    EXPECT_EQ(large.exit_code, 4);
    EXPECT_EQ(object_of(large)["parts"][0]["misfits"][0]["constraint"], "rotary.diameter");
}

TEST(Check, PicturesAndColouredMeshesAreWrittenOnceAndTheSameByAnyNumberOfJobs) {
    const tests::TempDir dir;
    const std::string hook = write_stl(dir, "hook.stl", tests::hook(10, 40, 15));
    for (const std::string process : {"fdm", "mill3", "mill4"}) {
        const auto run = [&](const std::string& out, const std::string& jobs) {
            return hew({"check", hook, "--process", process, "-o", (dir / out).string(), "--jobs",
                        jobs, "-q"})
                .exit_code;
        };
        const int first = run(process + "1", "1");
        EXPECT_TRUE(first == 0 || first == 4);
        EXPECT_EQ(run(process + "2", "2"), first);
        const auto one = contents(dir / (process + "1"));
        EXPECT_EQ(one, contents(dir / (process + "2")));
        EXPECT_TRUE(one.contains("hook.png") && one.contains("hook.ply"));
        EXPECT_EQ(run(process + "1", "1"), 6) << "must not overwrite without --force";
    }
}

TEST(Check, AGivenAxisIsTaken) {
    const tests::TempDir dir;
    const auto run = hew({"check", dome(dir), "--process", "mill4", "--axis", "0,0,2", "--json"});
    const Json answer = object_of(run);
    EXPECT_EQ(answer["parts"][0]["axis"], Json({0, 0, 1}));
    EXPECT_EQ(answer["parts"][0]["axes_compared"].size(), 1U);
    EXPECT_EQ(hew({"check", dome(dir), "--process", "mill4", "--axis", "up"}).exit_code, 2);
    EXPECT_EQ(hew({"check", dome(dir), "--process", "mill4", "--axis", "0,0,0"}).exit_code, 2);
}

TEST(Check, ToolsAreColumnsAndAMisspeltOneIsCorrected) {
    const tests::TempDir dir;
    const auto run = hew({"check", dome(dir), "--process", "mill3", "--tool", "ball-3", "--tool",
                          "flat-6", "--json"});
    const Json answer = object_of(run);
    ASSERT_EQ(answer["parts"][0]["tools"].size(), 2U);
    EXPECT_EQ(answer["parts"][0]["tools"][0]["tool"], "ball-3");
    const auto wrong = hew({"check", dome(dir), "--process", "mill3", "--tool", "bal-3"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_NE(wrong.err.find("did you mean 'ball-3'"), std::string::npos) << wrong.err;
}

TEST(Check, WhatIsNeverSeenIsDropped) {
    const tests::TempDir dir;
    const auto shape = tests::joined(tests::box({0, 0, 0}, {20, 20, 20}),
                                     tests::flipped(tests::box({5, 5, 5}, {10, 10, 10})));
    const std::string hollow = write_stl(dir, "hollow.stl", shape);
    const auto run = hew({"check", hollow, "--process", "mill4", "--axis", "x",
                          "--drop-unreachable", (dir / "out").string(), "--json"});
    const Json dropped = object_of(run)["parts"][0]["dropped"];
    EXPECT_EQ(dropped["cavities_filled"], 1);
    EXPECT_NEAR(dropped["volume_after_mm3"].get<double>(), 8000, 1e-3);
    EXPECT_TRUE(fs::exists(dir / "out/hollow.ply"));
}

TEST(Check, EveryPartOfAJobIsARow) {
    const tests::TempDir dir;
    const std::string bar = write_stl(dir, "bar.stl", tests::block(400, 40, 12));
    ASSERT_EQ(
        hew({"decompose", bar, "--machine", "prusa-mk3s", "-o", (dir / "job").string()}).exit_code,
        0);
    const auto run = hew({"check", (dir / "job").string(), "--process", "fdm", "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json answer = object_of(run);
    EXPECT_GE(answer["parts"].size(), 2U);
    EXPECT_TRUE(answer.contains("whole"));
    EXPECT_EQ(answer["parts"][0]["id"], "P01");
    const auto one =
        hew({"check", (dir / "job").string(), "--process", "mill3", "--part", "P02", "--json"});
    EXPECT_EQ(object_of(one)["parts"].size(), 1U);
    EXPECT_EQ(hew({"check", (dir / "job").string(), "--process", "fdm", "--part", "P99"}).exit_code,
              2);
}

}  // namespace
