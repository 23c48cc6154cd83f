// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/hew.h"

namespace {

using tests::contents;
using tests::hew;
using tests::with;
namespace fs = std::filesystem;

/// A bar that an MK3S can only make in two pieces.
std::string long_bar(const tests::TempDir& dir) {
    return tests::write_stl(dir, "bar.stl", tests::block(400, 20, 5));
}

std::vector<std::string> decompose(const std::string& model, const fs::path& out) {
    return {"decompose", model, "--machine", "prusa-mk3s", "-o", out.string(), "--json"};
}

std::string text_of(const fs::path& path) { return *decomp::read_file(path); }

void write(const fs::path& path, const std::string& text) {
    ASSERT_TRUE(decomp::write_file(path, text, decomp::Overwrite::Allow));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << text;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(Plan, OfAJobMadeByHandGivesTheSameBytesInAnotherDirectory) {
    const tests::TempDir dir;
    const std::string bar = long_bar(dir);
    const auto made =
        hew(with(decompose(bar, dir / "one"),
                 {"--split", "P01:y=0.5", "--plane", "-1 0 0 -20", "--merge", "P01.1.1+P01.2.1"}));
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto json = tests::object_of(made);
    EXPECT_EQ(json["parts"].size(), 4U);
    const auto again =
        hew(with(decompose(bar, dir / "two"), {"--plan", (dir / "one/plan.toml").string()}));
    ASSERT_EQ(again.exit_code, 0) << again.err;
    auto one = contents(dir / "one");
    auto two = contents(dir / "two");
    // The manifest keeps the options, which differ.
    one.erase("job.json");
    two.erase("job.json");
    EXPECT_EQ(one, two);
}

TEST(Plan, TheOrderOfEditsIsThatOfTheCommandLine) {
    const tests::TempDir dir;
    const std::string block = tests::write_stl(dir, "block.stl", tests::block(60, 40, 20));
    const auto split_first = hew(with(
        decompose(block, dir / "a"), {"--split", "P01:x=0.5", "--plane", "0 1 0 10", "--dry-run"}));
    EXPECT_EQ(split_first.exit_code, 0) << split_first.err;
    // The plane cuts P01 into pieces before the split can name it.
    const auto plane_first =
        hew(with(decompose(block, dir / "b"), {"--plane", "0 1 0 10", "--split", "P01:x=0.5"}));
    EXPECT_EQ(plane_first.exit_code, 2);
    EXPECT_EQ(tests::object_of(plane_first)["error"]["code"], "plan.no_such_part");
    EXPECT_EQ(
        hew(with(decompose(block, dir / "c"), {"--split", "P01:x=0.5", "--plane", "0 1 0 10"}))
            .exit_code,
        0);
    EXPECT_TRUE(fs::exists(dir / "c/parts/P04.ply"));
}

TEST(Plan, AChangedPlanIsNeverWrittenOverUnlessItIsTheOneCarriedOut) {
    const tests::TempDir dir;
    const std::string bar = long_bar(dir);
    ASSERT_EQ(hew(decompose(bar, dir / "out")).exit_code, 0);
    const fs::path plan = dir / "out/plan.toml";
    const std::string changed = text_of(plan) +
                                "\n# mine\n[[step]]\ncut = \"r0\"\nplane = [0, 1, 0, 10]\n"
                                "gives = [\"r0\", \"back\"]\n";
    write(plan, changed);
    const auto refused = hew(decompose(bar, dir / "out"));
    EXPECT_EQ(refused.exit_code, 6);
    EXPECT_EQ(tests::object_of(refused)["error"]["code"], "job.plan_changed");
    EXPECT_EQ(text_of(plan), changed);
    const auto words = with(decompose(bar, dir / "out"), {"--plan", plan.string()});
    const auto made = hew(words);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(tests::object_of(made)["parts"].size(), 3U);
    // The plan is laid out anew, and says the same: everything is kept.
    const auto again = tests::object_of(hew(words));
    EXPECT_EQ(again["stages_kept"], again["stages"]);
    const auto twice = hew(with(words, {"--split", "P01:x=0.5"}));
    EXPECT_EQ(twice.exit_code, 2);
    EXPECT_EQ(tests::object_of(twice)["error"]["code"], "job.plan_in_job");
}

TEST(Plan, AnEditMakesThePartsAnewAndLeavingItOutMakesThemAsBefore) {
    const tests::TempDir dir;
    const std::string bar = long_bar(dir);
    ASSERT_EQ(hew(decompose(bar, dir / "out")).exit_code, 0);
    const auto before = contents(dir / "out");
    ASSERT_EQ(hew(with(decompose(bar, dir / "out"), {"--split", "P01:y=0.5"})).exit_code, 0);
    EXPECT_TRUE(fs::exists(dir / "out/parts/P03.ply"));
    ASSERT_EQ(hew(decompose(bar, dir / "out")).exit_code, 0);
    EXPECT_EQ(contents(dir / "out"), before);
}

TEST(Plan, FaultsAreToldWithTheirPlaceAndTheirExit) {
    const tests::TempDir dir;
    const std::string bar = long_bar(dir);
    ASSERT_EQ(hew(decompose(bar, dir / "out")).exit_code, 0);
    const std::string plan = text_of(dir / "out/plan.toml");
    const fs::path bad = dir / "bad.toml";
    const auto run = [&] {
        return hew(with(decompose(bar, dir / "other"), {"--plan", bad.string()}));
    };
    write(bad, replaced(plan, "gives =", "gvies ="));
    const auto unknown = run();
    EXPECT_EQ(unknown.exit_code, 3);
    const auto error = tests::object_of(unknown)["error"];
    EXPECT_EQ(error["code"], "plan.unknown_key");
    EXPECT_EQ(error["hint"], "did you mean 'gives'?");
    EXPECT_TRUE(error["where"].get<std::string>().starts_with(bad.string() + ":")) << error;
    EXPECT_FALSE(fs::exists(dir / "other"));
    write(bad, replaced(plan, "cut = \"r0\"", "cut = \"r7\""));
    EXPECT_EQ(tests::object_of(run())["error"]["code"], "plan.no_such_region");
    const std::string other = tests::write_stl(dir, "other.stl", tests::block(400, 20, 6));
    const auto wrong =
        hew(with(decompose(other, dir / "wrong"), {"--plan", (dir / "out/plan.toml").string()}));
    EXPECT_EQ(wrong.exit_code, 3);
    EXPECT_EQ(tests::object_of(wrong)["error"]["code"], "plan.other_shape");
    EXPECT_EQ(hew(with(decompose(bar, dir / "x"), {"--split", "P01"})).exit_code, 2);
    const auto apart = hew(with(decompose(bar, dir / "y"), {"--merge", "P01+P02"}));
    EXPECT_EQ(apart.exit_code, 4);
    EXPECT_EQ(tests::object_of(apart)["error"]["code"], "plan.does_not_fit");
}

}  // namespace
