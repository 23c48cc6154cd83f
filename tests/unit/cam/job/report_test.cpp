// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using cam::job::JobFile;
using Json = nlohmann::json;

JobFile two_parts() {
    JobFile job;
    job.input.name = "statue.stl";
    job.decomposition.interfaces = {{0, 0, 1, 100}, {1, 0, 1, 50}};
    job.decomposition.necks_mm = {8, 5.0004};
    job.parts.resize(2);
    job.parts[0].id = "P01";
    job.parts[1].id = "P02";
    job.plates.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
        cam::job::PlateFacts& plate = job.plates[i];
        plate.name = "plate-" + std::to_string(i + 1);
        plate.parts = {{job.parts[i].id, Eigen::Vector2d::Zero()}};
        plate.proof.passed = true;
    }
    job.plates[0].program = {60, 100, 1.5, 0.25};
    job.plates[1].program = {90, 200, 2.5, 0.5};
    return job;
}

TEST(Report, TotalsAreTheSumsOfThePlates) {
    const Json json = Json::parse(cam::job::report_json(two_parts()));
    EXPECT_EQ(json["schema"], "hew.report/1");
    EXPECT_EQ(json["totals"]["seconds"], 150.0);
    EXPECT_EQ(json["totals"]["filament_g"], 4.0);
    EXPECT_EQ(json["totals"]["passed"], true);
}

TEST(Report, InterfacesSayHowThicklyPartsHangTogether) {
    const Json json = Json::parse(cam::job::report_json(two_parts()));
    EXPECT_EQ(json["interfaces"][0]["neck_mm"], 8.0);
    EXPECT_EQ(json["interfaces"][1]["neck_mm"], 5.0);
    EXPECT_EQ(json["interfaces"][1]["area_mm2"], 50.0);
}

TEST(Report, OneFailedProofFailsTheWhole) {
    JobFile job = two_parts();
    job.plates[1].proof.passed = false;
    EXPECT_FALSE(cam::job::totals_of(job).passed);
}

TEST(Report, AJobWithoutProgramsIsNotPassed) {
    JobFile job = two_parts();
    job.plates.clear();
    EXPECT_FALSE(cam::job::totals_of(job).passed);
}

TEST(Report, ANeighbourIsNamedOnceHoweverManyPlanesTouch) {
    const Json json = Json::parse(cam::job::report_json(two_parts()));
    EXPECT_EQ(json["parts"][0]["neighbours"], Json::array({"P02"}));
    EXPECT_EQ(json["parts"][1]["neighbours"], Json::array({"P01"}));
    EXPECT_EQ(json["interfaces"][0]["parts"], Json::array({"P01", "P02"}));
}

}  // namespace
