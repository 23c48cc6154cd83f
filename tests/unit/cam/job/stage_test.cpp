// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/stage.h"

#include "decomp/base/file.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <fstream>

namespace {

namespace fs = std::filesystem;
using cam::job::FileBytes;
using cam::job::JobFile;
using cam::job::StageKey;
using cam::job::StageRunner;

class Stages : public testing::Test {
  protected:
    /// Runs one stage that writes `files`; returns whether its body was called.
    bool made(StageRunner& runner, const std::string& name, const StageKey& key,
              std::vector<FileBytes> files) {
        bool called = false;
        const auto done = runner.run(
            name, key, 1, [&](const decomp::Run&) -> decomp::Result<std::vector<FileBytes>> {
                called = true;
                return files;
            });
        EXPECT_TRUE(done);
        return called;
    }

    tests::TempDir dir_;
    JobFile job_;
    decomp::Run run_;
};

TEST_F(Stages, AStageIsMadeOnce) {
    StageRunner first(dir_.path(), job_, run_);
    const StageKey key = StageKey("a", 1).add("x", "1");
    EXPECT_TRUE(made(first, "a", key, {{"a.txt", "alpha"}}));
    JobFile again = *cam::job::read_job(dir_.path());
    StageRunner second(dir_.path(), again, run_);
    EXPECT_FALSE(made(second, "a", key, {{"a.txt", "alpha"}}));
}

TEST_F(Stages, AnotherKeyMakesItAnew) {
    StageRunner runner(dir_.path(), job_, run_);
    EXPECT_TRUE(made(runner, "a", StageKey("a", 1).add("x", "1"), {{"a.txt", "alpha"}}));
    EXPECT_TRUE(made(runner, "a", StageKey("a", 1).add("x", "2"), {{"a.txt", "beta"}}));
    EXPECT_TRUE(made(runner, "a", StageKey("a", 2).add("x", "2"), {{"a.txt", "beta"}}));
}

TEST_F(Stages, AFileThatSomebodyChangedOrRemovedIsMadeAnew) {
    StageRunner runner(dir_.path(), job_, run_);
    const StageKey key("a", 1);
    EXPECT_TRUE(made(runner, "a", key, {{"sub/a.txt", "alpha"}}));
    std::ofstream(dir_.path() / "sub/a.txt") << "edited";
    EXPECT_TRUE(made(runner, "a", key, {{"sub/a.txt", "alpha"}}));
    fs::remove(dir_.path() / "sub/a.txt");
    EXPECT_TRUE(made(runner, "a", key, {{"sub/a.txt", "alpha"}}));
    EXPECT_EQ(*decomp::read_file(dir_.path() / "sub/a.txt"), "alpha");
}

TEST_F(Stages, OutputsThatAreNoLongerMadeAreRemoved) {
    StageRunner runner(dir_.path(), job_, run_);
    EXPECT_TRUE(made(runner, "a", StageKey("a", 1), {{"p1", "1"}, {"p2", "2"}}));
    EXPECT_TRUE(made(runner, "a", StageKey("a", 2), {{"p1", "1"}}));
    EXPECT_TRUE(fs::exists(dir_ / "p1"));
    EXPECT_FALSE(fs::exists(dir_ / "p2"));
}

TEST_F(Stages, FinishDropsStagesThatTheRunDidNotVisit) {
    StageRunner first(dir_.path(), job_, run_);
    EXPECT_TRUE(made(first, "a", StageKey("a", 1), {{"a", "1"}}));
    EXPECT_TRUE(made(first, "b", StageKey("b", 1), {{"b", "1"}}));
    ASSERT_TRUE(first.finish());
    StageRunner second(dir_.path(), job_, run_);
    EXPECT_FALSE(made(second, "a", StageKey("a", 1), {{"a", "1"}}));
    ASSERT_TRUE(second.finish());
    EXPECT_FALSE(fs::exists(dir_ / "b"));
    EXPECT_TRUE(cam::job::read_finished_job(dir_.path()));
}

TEST_F(Stages, AFailedStageLeavesNoRecord) {
    StageRunner runner(dir_.path(), job_, run_);
    const auto done = runner.run("a", StageKey("a", 1), 1, [](const decomp::Run&) {
        return decomp::Result<std::vector<FileBytes>>(decomp::fail("mesh.empty", "nothing"));
    });
    EXPECT_FALSE(done);
    EXPECT_EQ(job_.stage("a"), nullptr);
    EXPECT_FALSE(fs::exists(dir_ / "job.json"));
}

TEST_F(Stages, ACancelledRunStopsBeforeTheNextStage) {
    std::stop_source stop;
    stop.request_stop();
    run_.stop = stop.get_token();
    StageRunner runner(dir_.path(), job_, run_);
    const auto done = runner.run("a", StageKey("a", 1), 1, [](const decomp::Run&) {
        return decomp::Result<std::vector<FileBytes>>(std::vector<FileBytes>{});
    });
    EXPECT_EQ(done.error().code, "run.cancelled");
}

TEST_F(Stages, ProgressRisesToExactlyOne) {
    std::vector<double> fractions;
    run_.progress_sink = [&](const decomp::Progress& progress) {
        fractions.push_back(progress.fraction);
    };
    StageRunner runner(dir_.path(), job_, run_);
    runner.expect(2);
    EXPECT_TRUE(made(runner, "a", StageKey("a", 1), {}));
    EXPECT_TRUE(made(runner, "b", StageKey("b", 1), {}));
    ASSERT_TRUE(runner.finish());
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(fractions.back(), 1.0);
}

TEST_F(Stages, FieldsCannotRunIntoEachOther) {
    EXPECT_NE(StageKey("a", 1).add("x", "12").add("y", "3").hash(),
              StageKey("a", 1).add("x", "1").add("y", "23").hash());
    EXPECT_NE(StageKey("a", 1).add("x", "1\ny 1 2").hash(),
              StageKey("a", 1).add("x", "1").add("y", "2").hash());
}

TEST_F(Stages, ADirectoryServesOneRunAtATime) {
    auto first = cam::job::DirectoryLock::take(dir_.path());
    ASSERT_TRUE(first);
    EXPECT_EQ(cam::job::DirectoryLock::take(dir_.path()).error().code, "job.busy");
    { const cam::job::DirectoryLock released = std::move(*first); }
    EXPECT_TRUE(cam::job::DirectoryLock::take(dir_.path()));
}

TEST_F(Stages, LeftoversOfAKilledRunAreRemovedAndNothingElse) {
    fs::create_directories(dir_ / "plates");
    std::ofstream(dir_.path() / "plates/.hew-plate-1.gcode-abcdef") << "half";
    fs::create_directories(dir_.path() / "plates/.hew-convert-abcdef");
    std::ofstream(dir_.path() / "plates/.hew-convert-abcdef/plate-1.x3g") << "half";
    std::ofstream(dir_.path() / "notes.txt") << "mine";
    cam::job::remove_leftovers(dir_.path());
    EXPECT_FALSE(fs::exists(dir_.path() / "plates/.hew-convert-abcdef"));
    EXPECT_FALSE(fs::exists(dir_.path() / "plates/.hew-plate-1.gcode-abcdef"));
    EXPECT_TRUE(fs::exists(dir_ / "notes.txt"));
}

}  // namespace
