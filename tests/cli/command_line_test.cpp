// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/hew.h"

namespace {

using tests::hew;
using tests::Json;

bool says(const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
}

TEST(CommandLine, WithoutAVerbHelpGoesToStderr) {
    const auto run = hew({});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(run.out.empty());
    EXPECT_TRUE(says(run.err, "make"));
}

TEST(CommandLine, AMisspeltVerbIsAnsweredWithTheNearest) {
    const auto run = hew({"mkae", "x.stl"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(says(run.err, "did you mean 'make'")) << run.err;
}

TEST(CommandLine, AMisspeltOptionIsAnsweredWithTheNearest) {
    const auto run = hew({"make", "x.stl", "--machin", "prusa-mk3s", "-o", "out"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(says(run.err, "did you mean '--machine'")) << run.err;
}

TEST(CommandLine, AMisspeltMachineIsAnsweredWithTheNearest) {
    const auto run = hew({"machines", "show", "prusa-mk3"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(says(run.err, "prusa-mk3s")) << run.err;
}

TEST(CommandLine, AMissingOptionIsAUsageError) { EXPECT_EQ(hew({"make", "x.stl"}).exit_code, 2); }

TEST(CommandLine, AnAbsentFileIsBadInput) {
    const auto run = hew({"inspect", "/nonexistent/x.stl"});
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_TRUE(says(run.err, "file.not_found"));
}

TEST(CommandLine, AFileThatIsNoMeshIsBadInput) {
    const tests::TempDir dir;
    ASSERT_TRUE(decomp::write_file(dir / "x.stl", "this is no mesh"));
    EXPECT_EQ(hew({"inspect", (dir / "x.stl").string()}).exit_code, 3);
}

TEST(CommandLine, ALengthNeedsAKnownUnit) {
    for (const char* length : {"245furlong", "-3mm", "0", "mm", "nan"}) {
        const auto run =
            hew({"make", "x.stl", "--machine", "prusa-mk3s", "-o", "out", "--height", length});
        EXPECT_EQ(run.exit_code, 2) << length;
    }
}

TEST(CommandLine, AnAxisWithMinusIsAValueNotAnOption) {
    const auto run =
        hew({"make", "/nonexistent/x.stl", "--machine", "prusa-mk3s", "-o", "out", "--up", "-z"});
    EXPECT_EQ(run.exit_code, 3) << run.err;
}

TEST(CommandLine, JsonIsOneObjectOnSuccessAndOnFailure) {
    const tests::TempDir dir;
    const std::string cube = tests::write_stl(dir, "cube.stl", tests::block(20, 20, 20));
    const auto inspected = hew({"inspect", cube, "--json"});
    EXPECT_EQ(inspected.exit_code, 0);
    EXPECT_EQ(tests::object_of(inspected)["ok"], true);
    EXPECT_NEAR(tests::object_of(inspected)["volume_mm3"].get<double>(), 8000, 1e-6);
    EXPECT_EQ(tests::object_of(hew({"machines", "--json"}))["machines"].size() >= 2, true);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"inspect", "/nonexistent/x.stl", "--json"},
          {"mkae", "--json"},
          {"make", "--json"},
          {"make", "x.stl", "--bogus", "--json"},
          {"machines", "show", "--json"}}) {
        const auto run = hew(words);
        const Json json = tests::object_of(run);
        EXPECT_EQ(json["ok"], false);
        EXPECT_EQ(json["exit_code"], run.exit_code);
        EXPECT_FALSE(json["error"]["code"].get<std::string>().empty());
    }
}

TEST(CommandLine, AnExistingFileIsNotOverwrittenWithoutForce) {
    const tests::TempDir dir;
    const std::string out = (dir / "statue.stl").string();
    EXPECT_EQ(hew({"demo", out, "--cell", "20"}).exit_code, 0);
    EXPECT_EQ(hew({"demo", out, "--cell", "20"}).exit_code, 6);
    EXPECT_EQ(hew({"demo", out, "--cell", "20", "--force"}).exit_code, 0);
}

TEST(CommandLine, TheDemoStatueIsASoundSolidAndAlwaysTheSame) {
    const tests::TempDir dir;
    const std::string out = (dir / "statue.stl").string();
    ASSERT_EQ(hew({"demo", out}).exit_code, 0);
    const std::string first = *decomp::read_file(out);
    ASSERT_EQ(hew({"demo", out, "--force"}).exit_code, 0);
    EXPECT_TRUE(first == *decomp::read_file(out));
    const Json json = tests::object_of(hew({"inspect", out, "--json"}));
    EXPECT_EQ(json["repair"]["status"], "clean");
    EXPECT_EQ(json["crossing_pairs"], 0);
    EXPECT_EQ(json["topology"]["components"], 1);
}

TEST(CommandLine, LogsNeverReachStdout) {
    const tests::TempDir dir;
    const std::string cube = tests::write_stl(dir, "cube.stl", tests::block(20, 20, 20));
    const auto run = hew({"inspect", cube, "-q"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_TRUE(run.out.empty());
    EXPECT_TRUE(run.err.empty()) << run.err;
}

}  // namespace
