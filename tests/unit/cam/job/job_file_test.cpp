// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/job_file.h"

#include "decomp/base/file.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

namespace {

using cam::job::JobFile;

JobFile sample_job() {
    JobFile job;
    job.version = "1.2.3";
    job.input = {"statue.stl", 1234, std::string(64, 'a')};
    job.options.machine = "prusa-mk3s";
    job.options.settings = {"process.layer_height_mm=0.15"};
    job.options.height_mm = 245.1;
    job.options.plan = "plan.toml";
    job.options.edits = {"split P03:z=0.5", "plane 0 0 1 50"};
    job.profile_sha256 = std::string(64, 'b');
    job.finished = true;
    job.model.model_from_file[0] = 0.1;
    job.model.repair_status = "united";
    job.model.repair_changes = {"2 shells were united"};
    job.decomposition.tier = "T4";
    job.decomposition.planes = {{{0, 0, 1}, 0.1}};
    job.decomposition.interfaces = {{0, 0, 1, 12.5}};
    job.decomposition.necks_mm = {3.5};
    Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
    map.translation() = Eigen::Vector3d(1.0 / 3, -0.0, 2);
    cam::job::PartFacts part;
    part.id = "P01";
    part.base = "plane 0";
    part.part_from_model = decltype(part.part_from_model)(map);
    job.parts = {part};
    cam::job::PlateFacts plate;
    plate.name = "plate-1";
    plate.parts = {{"P01", {10.1, -20.2}}};
    plate.proof.passed = true;
    job.plates = {plate};
    job.stages = {{"model", std::string(64, 'c'), {{"model.ply", std::string(64, 'd')}}}};
    return job;
}

TEST(JobFile, WhatWasWrittenIsReadBackBitForBit) {
    const JobFile job = sample_job();
    const std::string text = cam::job::job_json(job);
    const auto read = cam::job::parse_job_json(text, "job.json");
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(cam::job::job_json(*read), text);
    EXPECT_EQ(read->options, job.options);
    EXPECT_EQ(read->parts[0].part_from_model.map().translation().x(), 1.0 / 3);
    EXPECT_EQ(read->plates[0].parts[0].offset_mm, job.plates[0].parts[0].offset_mm);
}

TEST(JobFile, NoNumberIsMinusZero) {
    EXPECT_EQ(cam::job::job_json(sample_job()).find("-0.0"), std::string::npos);
}

TEST(JobFile, APartKnowsItsPlateAndItsPoseOnTheBed) {
    const std::string text = cam::job::job_json(sample_job());
    EXPECT_NE(text.find("\"plate\": \"plate-1\""), std::string::npos);
    EXPECT_NE(text.find("\"bed_from_model\""), std::string::npos);
}

TEST(JobFile, AnUnknownSchemaIsRefused) {
    const auto read = cam::job::parse_job_json(R"({"schema": "hew.job/99"})", "job.json");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, "job.schema");
}

TEST(JobFile, ATornManifestIsAnErrorAndNoCrash) {
    const std::string text = cam::job::job_json(sample_job());
    for (std::size_t length = 0; length < text.size(); length += 97) {
        EXPECT_FALSE(cam::job::parse_job_json(text.substr(0, length), "job.json"));
    }
    EXPECT_EQ(cam::job::parse_job_json("[1]", "job.json").error().code, "job.unreadable");
}

TEST(JobFile, ADirectoryWithoutManifestIsNoJob) {
    const tests::TempDir dir;
    EXPECT_EQ(cam::job::read_job(dir.path()).error().code, "job.not_a_job");
}

TEST(JobFile, AnInterruptedJobIsToldFromAFinishedOne) {
    const tests::TempDir dir;
    JobFile job = sample_job();
    job.finished = false;
    ASSERT_TRUE(decomp::write_file(dir / "job.json", cam::job::job_json(job)));
    EXPECT_TRUE(cam::job::read_job(dir.path()));
    EXPECT_EQ(cam::job::read_finished_job(dir.path()).error().code, "job.unfinished");
}

}  // namespace
