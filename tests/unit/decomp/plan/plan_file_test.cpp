// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/plan/plan_file.h"

#include "decomp/base/rng.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using decomp::plan::parse_plan;
using decomp::plan::Plan;
using decomp::plan::plan_toml;
using decomp::plan::Step;

/// A plan with every key, and with numbers that need all their digits.
Plan full_plan() {
    decomp::Rng rng(3);
    Plan plan;
    plan.shape_sha256 = std::string(64, 'a');
    plan.origin = {"paper", "global", true, "made", "T2", 7, {"two \"pairs\" united", "a\\b\n"}};
    Step cut;
    cut.region = "r0";
    cut.plane.normal =
        Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)).normalized();
    cut.plane.offset_mm = rng.uniform(-1e-7, 1e-7);
    cut.loops_mm = {{rng.uniform(-1, 1), 1, -2e300}, {0, 0, 1.0 / 3}};
    cut.names = {"r0", "head", "r2"};
    cut.by = "sheet z 1";
    Step merge;
    merge.kind = Step::Kind::Merge;
    merge.region = "head";
    merge.names = {"r0", "r2"};
    merge.by = "hand: merge P01+P02";
    plan.steps = {cut, merge};
    return plan;
}

TEST(PlanFile, WhatIsReadIsWhatWasWritten) {
    const Plan plan = full_plan();
    const auto read = parse_plan(plan_toml(plan, {"head"}), "plan.toml");
    ASSERT_TRUE(read.has_value()) << read.error().text();
    EXPECT_EQ(read->shape_sha256, plan.shape_sha256);
    EXPECT_EQ(read->origin, plan.origin);
    ASSERT_EQ(read->steps.size(), plan.steps.size());
    for (std::size_t i = 0; i < plan.steps.size(); ++i) {
        const Step& got = read->steps[i];
        const Step& want = plan.steps[i];
        EXPECT_EQ(got.kind, want.kind);
        EXPECT_EQ(got.region, want.region);
        EXPECT_EQ(got.names, want.names);
        EXPECT_EQ(got.by, want.by);
        EXPECT_EQ(got.loops_mm, want.loops_mm);
        if (want.kind == Step::Kind::Cut) {
            EXPECT_EQ(got.plane.normal, want.plane.normal);
            EXPECT_EQ(got.plane.offset_mm, want.plane.offset_mm);
        }
    }
    EXPECT_EQ(plan_toml(*read), plan_toml(plan));
}

TEST(PlanFile, StepsKnowWhereTheyStand) {
    const auto read = parse_plan(
        "schema = 1\n[shape]\nsha256 = \"\"\n\n[[step]]\ncut = \"r0\"\nplane = [0, 0, 1, 5]\n",
        "dir/plan.toml");
    ASSERT_TRUE(read.has_value()) << read.error().text();
    EXPECT_TRUE(read->steps.at(0).where.starts_with("dir/plan.toml:5:")) << read->steps.at(0).where;
}

struct Fault {
    const char* text;  ///< after the head, which has three lines
    const char* code;
    const char* where;
    const char* hint;
};

TEST(PlanFile, EveryFaultHasItsCodeItsPlaceAndWhereItCanASuggestion) {
    const std::string head = "schema = 1\n[shape]\nsha256 = \"00\"\n";
    const std::vector<Fault> faults{
        {"[[step]]\ncut = \"r0\"\nplane = [0, 0, 1, 5]\ngvies = [\"a\", \"b\"]\n",
         "plan.unknown_key", "p:7:1", "did you mean 'gives'?"},
        {"[[step]]\nmerge = [\"a\", \"b\"]\nplane = [0, 0, 1, 5]\n", "plan.unknown_key", "p:6:1",
         ""},
        {"[orign]\n", "plan.unknown_key", "p:4:2", "did you mean 'origin'?"},
        {"[origin]\nmode = \"sheet\"\n", "plan.out_of_range", "p:5:8", "did you mean 'sheets'?"},
        {"[origin]\nsweep = \"all\"\n", "plan.out_of_range", "p:5:9", ""},
        {"[origin]\npolycube = \"mad\"\n", "plan.out_of_range", "p:5:12", "did you mean 'made'?"},
        {"[origin]\nboxes = 1\n", "plan.wrong_type", "p:5:9", ""},
        {"[origin]\nseed = 1.5\n", "plan.wrong_type", "p:5:8", ""},
        {"[origin]\nnotes = [1]\n", "plan.wrong_type", "p:5:9", ""},
        {"origin = 3\n", "plan.wrong_type", "p:4:10", ""},
        {"step = 3\n", "plan.wrong_type", "p:4:8", ""},
        {"[step]\n", "plan.wrong_type", "p:4:1", ""},
        {"[[step]]\nplane = [0, 0, 1, 5]\n", "plan.missing_key", "p:4:1", nullptr},
        {"[[step]]\ncut = \"a\"\nmerge = [\"a\", \"b\"]\n", "plan.missing_key", "p:4:1", nullptr},
        {"[[step]]\ncut = \"r0\"\n", "plan.missing_key", "p:4:1", ""},
        {"[[step]]\ncut = 0\nplane = [0, 0, 1, 5]\n", "plan.wrong_type", "p:5:7", ""},
        {"[[step]]\ncut = \"r0\"\nplane = [0, 0, 1]\n", "plan.wrong_type", "p:6:9", ""},
        {"[[step]]\ncut = \"r0\"\nplane = [0, 0, 1, nan]\n", "plan.wrong_type", "p:6:9", ""},
        {"[[step]]\ncut = \"r0\"\nplane = [0, 0, 2, 5]\n", "plan.out_of_range", "p:6:9", ""},
        {"[[step]]\ncut = \"r0\"\nplane = [0, 0, 1, 5]\nloops = []\n", "plan.wrong_type", "p:7:9",
         ""},
        {"[[step]]\ncut = \"r0\"\nplane = [0, 0, 1, 5]\nloops = [[1, 2]]\n", "plan.wrong_type",
         "p:7:10", ""},
        {"[[step]]\ncut = \"r0\"\nplane = [0, 0, 1, 5]\ngives = [\"a\", \"a\"]\n",
         "plan.out_of_range", "p:7:9", ""},
        {"[[step]]\nmerge = [\"a\"]\n", "plan.out_of_range", "p:5:9", ""},
        {"[[step]]\nmerge = [\"a\", \"a\"]\n", "plan.out_of_range", "p:5:9", ""},
        {"[[step]]\nmerge = \"a\"\n", "plan.wrong_type", "p:5:9", ""},
        {"[[step]\n", "plan.syntax", "p:4:8", nullptr},
    };
    for (const Fault& fault : faults) {
        // Keys of the file itself stand before its first section.
        const bool top = fault.text[0] != '[';
        const std::string text =
            top ? "\n\nschema = 1\n" + std::string(fault.text) + "[shape]\nsha256 = \"00\"\n"
                : head + fault.text;
        const auto read = parse_plan(text, "p");
        ASSERT_FALSE(read.has_value()) << fault.text;
        EXPECT_EQ(read.error().code, fault.code) << fault.text << read.error().text();
        EXPECT_EQ(read.error().where, fault.where) << fault.text << read.error().text();
        if (fault.hint != nullptr) {
            EXPECT_EQ(read.error().hint, fault.hint) << fault.text;
        }
    }
}

TEST(PlanFile, AnotherSchemaAndAMissingShapeAreRefused) {
    EXPECT_EQ(parse_plan("schema = 2\n[shape]\nsha256 = \"\"\n", "p").error().code, "plan.schema");
    EXPECT_EQ(parse_plan("[shape]\nsha256 = \"\"\n", "p").error().code, "plan.schema");
    EXPECT_EQ(parse_plan("schema = 1\n", "p").error().code, "plan.missing_key");
    EXPECT_EQ(parse_plan("schema = 1\n[shape]\n", "p").error().code, "plan.missing_key");
}

TEST(PlanFile, AllFaultsAreToldAtOnce) {
    const auto read = parse_plan(
        "schema = 1\n[shape]\nsha256 = 4\n[[step]]\ncut = \"a\"\nplane = [1, 0, 0, 5]\nbi = \"\"\n",
        "p");
    ASSERT_FALSE(read.has_value());
    EXPECT_EQ(read.error().where, "p:3:10");
    ASSERT_EQ(read.error().notes.size(), 1U);
    EXPECT_EQ(read.error().notes[0], "p:7:1: unknown key 'bi' in a cut; did you mean 'by'?");
}

}  // namespace
