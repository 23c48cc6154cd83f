// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/hew.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using tests::contents;
using tests::hew;
using tests::Json;
using tests::quick_make;
using tests::with;

/// A bar that is too long for the bed.
std::string long_bar(const tests::TempDir& dir) {
    return tests::write_stl(dir, "bar.stl", tests::block(400, 40, 12));
}

Json read_json(const fs::path& path) { return Json::parse(*decomp::read_file(path)); }

TEST(Make, ABarThatIsTooLongBecomesProvedPrograms) {
    const tests::TempDir dir;
    const auto run = hew(with(quick_make(long_bar(dir), dir / "out"), {"--json"}));
    ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
    const Json answer = tests::object_of(run);
    EXPECT_GE(answer["parts"].size(), 2U);
    EXPECT_EQ(answer["totals"]["passed"], true);
    const Json report = read_json(dir.path() / "out/report.json");
    double volume = 0;
    for (const Json& part : report["parts"]) {
        volume += part["volume_mm3"].get<double>();
        EXPECT_TRUE(
            fs::exists(dir.path() / "out/parts" / (part["id"].get<std::string>() + ".ply")));
        EXPECT_TRUE(
            fs::exists(dir.path() / "out/parts" / (part["id"].get<std::string>() + ".stl")));
    }
    EXPECT_NEAR(volume, 400 * 40 * 12, 1e-3);
    for (const Json& plate : report["plates"]) {
        EXPECT_EQ(plate["proof"]["passed"], true);
        const std::string program = plate["program"];
        EXPECT_TRUE(fs::exists(dir.path() / "out" / program));
        EXPECT_TRUE(fs::exists(dir.path() / "out" / (program + ".proof.json")));
    }
    for (const char* name :
         {"job.json", "timings.json", "model.ply", "assembly.3mf", "parts.png"}) {
        EXPECT_TRUE(fs::exists(dir.path() / "out" / name)) << name;
    }
}

TEST(Make, SameBytesAtOneAndTwoThreadsAndOnASecondRun) {
    const tests::TempDir dir;
    const std::string bar = long_bar(dir);
    ASSERT_EQ(hew(with(quick_make(bar, dir / "a"), {"--jobs", "1"})).exit_code, 0);
    ASSERT_EQ(hew(with(quick_make(bar, dir / "b"), {"--jobs", "2"})).exit_code, 0);
    const auto first = contents(dir / "a");
    EXPECT_EQ(first, contents(dir / "b"));
    const auto again = hew(with(quick_make(bar, dir / "a"), {"--json"}));
    ASSERT_EQ(again.exit_code, 0);
    EXPECT_EQ(first, contents(dir / "a"));
    const Json answer = tests::object_of(again);
    EXPECT_EQ(answer["stages"], answer["stages_kept"]);
}

TEST(Make, NothingInAJobNamesTheFolderOrTheClock) {
    const tests::TempDir dir;
    ASSERT_EQ(hew(quick_make(long_bar(dir), dir / "out")).exit_code, 0);
    const std::string folder = dir.path().filename().string();
    for (const auto& entry : fs::recursive_directory_iterator(dir / "out")) {
        if (entry.is_regular_file()) {
            EXPECT_EQ(decomp::read_file(entry.path())->find(folder), std::string::npos)
                << entry.path();
        }
    }
}

TEST(Make, ADryRunWritesNothing) {
    const tests::TempDir dir;
    const auto run = hew(with(quick_make(long_bar(dir), dir / "out"), {"--dry-run", "--json"}));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_GE(tests::object_of(run)["blocks"].get<int>(), 2);
    EXPECT_FALSE(fs::exists(dir / "out"));
}

TEST(Make, ADirectoryThatIsNoJobIsRefusedWithoutForce) {
    const tests::TempDir dir;
    fs::create_directories(dir / "out");
    std::ofstream(dir.path() / "out/thesis.txt") << "years of work";
    const std::string bar = long_bar(dir);
    const auto refused = hew(with(quick_make(bar, dir / "out"), {"--json"}));
    EXPECT_EQ(refused.exit_code, 6);
    EXPECT_EQ(tests::object_of(refused)["error"]["code"], "job.not_empty");
    EXPECT_EQ(hew(with(quick_make(bar, dir / "out"), {"--force"})).exit_code, 0);
    EXPECT_TRUE(fs::exists(dir.path() / "out/thesis.txt"));
}

TEST(Make, AnotherModelsJobIsNotReplacedWithoutForce) {
    const tests::TempDir dir;
    const std::string one = tests::write_stl(dir, "one.stl", tests::block(40, 40, 6));
    const std::string two = tests::write_stl(dir, "two.stl", tests::block(30, 40, 6));
    ASSERT_EQ(hew(quick_make(one, dir / "out")).exit_code, 0);
    const auto refused = hew(with(quick_make(two, dir / "out"), {"--json"}));
    EXPECT_EQ(tests::object_of(refused)["error"]["code"], "job.other_model");
    ASSERT_EQ(hew(with(quick_make(two, dir / "out"), {"--force"})).exit_code, 0);
    ASSERT_EQ(hew(quick_make(two, dir / "clean")).exit_code, 0);
    EXPECT_EQ(contents(dir / "out"), contents(dir / "clean"));
}

TEST(Make, ChangedOptionsGiveWhatACleanRunGives) {
    const tests::TempDir dir;
    const std::string bar = long_bar(dir);
    ASSERT_EQ(hew(quick_make(bar, dir / "out")).exit_code, 0);
    const std::vector<std::string> other{"--set", "process.perimeters=2"};
    const auto again = hew(with(with(quick_make(bar, dir / "out"), other), {"--json"}));
    ASSERT_EQ(again.exit_code, 0);
    // Model, parts, picture and assembly do not depend on the walls.
    EXPECT_GE(tests::object_of(again)["stages_kept"].get<int>(), 4);
    ASSERT_EQ(hew(with(quick_make(bar, dir / "clean"), other)).exit_code, 0);
    EXPECT_EQ(contents(dir / "out"), contents(dir / "clean"));
}

TEST(Make, DecomposeStopsAtThePartsAndMakeContinues) {
    const tests::TempDir dir;
    auto words = quick_make(long_bar(dir), dir / "out");
    words[0] = "decompose";
    ASSERT_EQ(hew(words).exit_code, 0);
    EXPECT_TRUE(fs::exists(dir.path() / "out/parts/P02.ply"));
    EXPECT_FALSE(fs::exists(dir.path() / "out/plates"));
    words[0] = "make";
    const auto run = hew(with(words, {"--json"}));
    ASSERT_EQ(run.exit_code, 0);
    EXPECT_GE(tests::object_of(run)["stages_kept"].get<int>(), 4);
}

/// Whether a program is on the search path.
bool is_installed(const std::string& program) {
    return tests::run_program({"/bin/sh", "-c", "command -v " + program}).exit_code == 0;
}

std::vector<std::string> make_for_flashforge(const tests::TempDir& dir) {
    return {"make",      tests::write_stl(dir, "tile.stl", tests::block(30, 30, 3)),
            "--machine", "flashforge-creator-pro",
            "-o",        (dir / "out").string()};
}

TEST(Make, TheConvertedProgramLiesBesideTheProgramAndBearsItsName) {
    if (!is_installed("gpx")) {
        GTEST_SKIP() << "gpx is not installed";
    }
    const tests::TempDir dir;
    ASSERT_EQ(hew(make_for_flashforge(dir)).exit_code, 0);
    const auto bytes = decomp::read_file(dir.path() / "out/plates/plate-1.x3g");
    ASSERT_TRUE(bytes);
    EXPECT_NE(bytes->find("plate-1"), std::string::npos);
    EXPECT_EQ(bytes->find(".hew"), std::string::npos);
}

TEST(Make, WithoutTheConverterTheProgramStaysAndAWarningIsGiven) {
    const tests::TempDir dir;
    auto words = make_for_flashforge(dir);
    words.insert(words.begin(), {"/usr/bin/env", "PATH=/nonexistent", HEW_PROGRAM});
    const auto run = tests::run_program(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("gpx"), std::string::npos) << run.err;
    EXPECT_TRUE(fs::exists(dir.path() / "out/plates/plate-1.gcode"));
    EXPECT_FALSE(fs::exists(dir.path() / "out/plates/plate-1.x3g"));
    if (is_installed("gpx")) {
        ASSERT_EQ(hew(make_for_flashforge(dir)).exit_code, 0);
        EXPECT_TRUE(fs::exists(dir.path() / "out/plates/plate-1.x3g"));
    }
}

TEST(Slice, APartOfAJobGetsAProgramOfItsOwn) {
    const tests::TempDir dir;
    ASSERT_EQ(hew(quick_make(long_bar(dir), dir / "out")).exit_code, 0);
    const auto run = hew({"slice", (dir / "out").string(), "--part", "P01", "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(tests::object_of(run)["passed"], true);
    EXPECT_TRUE(fs::exists(dir.path() / "out/programs/P01.gcode"));
    EXPECT_EQ(hew({"slice", (dir / "out").string(), "--part", "P01"}).exit_code, 6);
    const auto unknown = hew({"slice", (dir / "out").string(), "--part", "P77"});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_EQ(hew({"verify", (dir / "out").string()}).exit_code, 0);
}

TEST(Slice, ALoneMeshIsSlicedAndProved) {
    const tests::TempDir dir;
    const std::string cube = tests::write_stl(dir, "cube.stl", tests::block(20, 20, 10));
    const std::string program = (dir / "cube.gcode").string();
    const auto run = hew({"slice", cube, "--machine", "prusa-mk3s", "-o", program, "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(tests::object_of(run)["passed"], true);
    const auto verified =
        hew({"verify", program, "--part", cube, "--machine", "prusa-mk3s", "--json"});
    EXPECT_EQ(verified.exit_code, 0) << verified.out;
    EXPECT_EQ(hew({"slice", cube, "--machine", "prusa-mk3s"}).exit_code, 2);
}

TEST(Slice, AMeshLargerThanTheChamberIsInfeasible) {
    const tests::TempDir dir;
    const auto run = hew(
        {"slice", long_bar(dir), "--machine", "prusa-mk3s", "-o", (dir / "bar.gcode").string()});
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_FALSE(fs::exists(dir / "bar.gcode"));
}

/// A fault is put into a good program by hand: the proof finds it, names the line, and the exit
/// code is 5.
TEST(Verify, AFaultInAProgramIsFoundWithItsLine) {
    const tests::TempDir dir;
    const std::string cube = tests::write_stl(dir, "cube.stl", tests::block(20, 20, 10));
    const std::string program = (dir / "cube.gcode").string();
    ASSERT_EQ(hew({"slice", cube, "--machine", "prusa-mk3s", "-o", program}).exit_code, 0);
    std::istringstream lines(*decomp::read_file(program));
    const std::regex bead("G1 X\\S+ Y\\S+ E\\S+.*");
    std::string text;
    std::string line;
    long number = 0;
    long beads = 0;
    long seeded = 0;
    while (std::getline(lines, line)) {
        ++number;
        beads += std::regex_match(line, bead) ? 1 : 0;
        if (beads == 100 && seeded == 0) {
            line = std::regex_replace(line, std::regex("X\\S+"), "X900");
            seeded = number;
        }
        text += line + "\n";
    }
    ASSERT_GT(seeded, 0);
    ASSERT_TRUE(decomp::write_file(program, text, decomp::Overwrite::Allow));
    const auto run = hew({"verify", program, "--part", cube, "--machine", "prusa-mk3s", "--json"});
    EXPECT_EQ(run.exit_code, 5);
    const Json faults = tests::object_of(run)["faults"];
    EXPECT_TRUE(std::any_of(faults.begin(), faults.end(), [&](const Json& fault) {
        return fault["line"] == seeded;
    })) << faults.dump(1);
}

TEST(Render, PartsLayersAndLoneMeshesBecomePictures) {
    const tests::TempDir dir;
    const std::string bar = long_bar(dir);
    auto words = quick_make(bar, dir / "out");
    words[0] = "decompose";
    ASSERT_EQ(hew(words).exit_code, 0);
    const std::string job = (dir / "out").string();
    for (const std::vector<std::string>& what :
         {std::vector<std::string>{job, "--explode", "1", "--view", "top"},
          {job, "--layers", "4", "--part", "P02"},
          {bar, "--view", "front"}}) {
        const std::string png = (dir / "x.png").string();
        const auto run = hew(with(with({"render"}, what),
                                  {"-o", png, "--force", "--size-x", "200", "--size-y", "150"}));
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(decomp::read_file(png)->substr(1, 3), "PNG");
    }
}

}  // namespace
