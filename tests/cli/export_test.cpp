// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/hew.h"
#include "tests/support/machined.h"

#include <cmath>
#include <numbers>

namespace {

using namespace tests;

/// A plate with a hole, cut in two by the bed's width: a job that takes a moment.
std::string drilled_job(const TempDir& dir) {
    const std::string model = write_stl(dir, "plate.stl", drilled_plate(360, 60, 20, 12, 48));
    const auto made =
        hew({"decompose", model, "--machine", "prusa-mk3s", "-o", (dir / "out").string(), "-q"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return (dir / "out").string();
}

TEST(Export, PartsAndAssemblyBecomeSoundSolidsWithTrueHoles) {
    const TempDir dir;
    const std::string out = drilled_job(dir);
    const Finished exported = hew({"export", out, "--step", "--json"});
    ASSERT_EQ(exported.exit_code, 0) << exported.err;
    const Json json = object_of(exported);
    ASSERT_GE(json["parts"].size(), 2U);
    const Json whole = object_of(hew({"inspect", json["assembly"], "--json"}));
    ASSERT_EQ(whole["bodies"].size(), json["parts"].size());
    double volume = 0;
    std::size_t cylinders = 0;
    for (const Json& body : whole["bodies"]) {
        EXPECT_TRUE(body["valid"]);
        EXPECT_TRUE(body["closed"]);
        EXPECT_FALSE(body["colour"].is_null());
        volume += body["volume_mm3"].get<double>();
        for (const double radius : body["cylinder_radii_mm"]) {
            EXPECT_NEAR(radius, 12, 1e-4) << "STL keeps floats";
            ++cylinders;
        }
    }
    EXPECT_GE(cylinders, 1U);
    const double exact = 360 * 60 * 20 - std::numbers::pi * 144 * 20;
    EXPECT_NEAR(volume, exact, 1e-5 * exact) << "chords stay where a cut splits one";
    // In its own file a part stands on the bed, centred.
    const Json part = object_of(hew({"inspect", json["parts"][0]["file"], "--json"}));
    EXPECT_NEAR(part["bodies"][0]["min_mm"][2].get<double>(), 0, 1e-6);
    EXPECT_NEAR(
        part["bodies"][0]["min_mm"][0].get<double>() + part["bodies"][0]["max_mm"][0].get<double>(),
        0, 1e-4);
}

TEST(Export, TheSameJobGivesTheSameBytesAndMakeKeepsThem) {
    const TempDir dir;
    const std::string out = drilled_job(dir);
    ASSERT_EQ(hew({"export", out, "--step", "-q"}).exit_code, 0);
    const auto first = contents(out);
    EXPECT_TRUE(first.contains("step/P01.step"));
    fs::remove_all(fs::path(out) / "step");
    ASSERT_EQ(hew({"export", out, "--step", "-q"}).exit_code, 0);
    EXPECT_EQ(contents(out), first);
    // Nothing is left to do for the verb that made the job.
    const auto again = hew({"decompose", (dir / "plate.stl").string(), "--machine", "prusa-mk3s",
                            "-o", out, "--json"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(contents(out).at("step/P01.step"), first.at("step/P01.step"));
}

TEST(Export, MakeWritesThemOnItsWay) {
    const TempDir dir;
    const std::string model = write_stl(dir, "block.stl", block(30, 20, 10));
    const auto made =
        hew(with(quick_make(model, dir / "out"), {"--step", "--step-schema", "ap242"}));
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto text = decomp::read_file(dir / "out" / "step" / "P01.step");
    ASSERT_TRUE(text);
    EXPECT_NE(text->find("AP242"), std::string::npos);
    const Json report = Json::parse(*decomp::read_file(dir / "out" / "report.json"));
    EXPECT_EQ(report["step"][0]["faces"], 6);
}

TEST(Export, StockAndFixtureStandBesideThePartWhereAsked) {
    const TempDir dir;
    const std::string out = drilled_job(dir);
    const std::string vise = write_stl(dir, "vise.stl", block(200, 30, 10));
    const auto exported =
        hew({"export", out, "--step", "--step-stock", "3mm", "--step-fixture", vise, "--json"});
    ASSERT_EQ(exported.exit_code, 0) << exported.err;
    const Json json = object_of(exported);
    const Json bodies = object_of(hew({"inspect", json["parts"][0]["file"], "--json"}))["bodies"];
    ASSERT_EQ(bodies.size(), 3U);
    const Json& part = bodies[0];
    const Json& stock = bodies[1];
    const Json& fixture = bodies[2];
    EXPECT_EQ(part["name"], "P01");
    EXPECT_EQ(stock["name"], "stock");
    EXPECT_EQ(fixture["name"], "fixture");
    double block_mm3 = 1;
    for (int k = 0; k < 3; ++k) {
        const double below = k == 2 ? 0 : 3;
        const double low = stock["min_mm"][k].get<double>();
        const double high = stock["max_mm"][k].get<double>();
        EXPECT_NEAR(low, part["min_mm"][k].get<double>() - below, 1e-4);
        EXPECT_NEAR(high, part["max_mm"][k].get<double>() + 3, 1e-4);
        block_mm3 *= high - low;
    }
    EXPECT_NEAR(stock["volume_mm3"].get<double>(), block_mm3, 1e-6 * block_mm3);
    EXPECT_NEAR(fixture["volume_mm3"].get<double>(), 200 * 30 * 10, 1e-3);
    EXPECT_TRUE(fixture["valid"]);
    // The assembly has the parts alone, and the verb that made the job leaves all that as it is.
    const Json whole = object_of(hew({"inspect", json["assembly"], "--json"}));
    EXPECT_EQ(whole["bodies"].size(), json["parts"].size());
    const auto before = contents(out);
    ASSERT_EQ(
        hew({"decompose", (dir / "plate.stl").string(), "--machine", "prusa-mk3s", "-o", out, "-q"})
            .exit_code,
        0);
    EXPECT_EQ(contents(out).at("step/P01.step"), before.at("step/P01.step"));
}

TEST(Export, AFixtureThatIsNotThereIsAnErrorAndAStockWithoutStepToo) {
    const TempDir dir;
    const std::string out = drilled_job(dir);
    const auto missing =
        hew({"export", out, "--step", "--step-fixture", (dir / "none.stl").string(), "--json"});
    EXPECT_EQ(missing.exit_code, 3) << missing.err;
    EXPECT_EQ(hew({"export", out, "--step-stock", "3mm"}).exit_code, 2);
}

TEST(Export, AStepFileIsAModelLikeAnyOther) {
    const TempDir dir;
    const std::string out = drilled_job(dir);
    ASSERT_EQ(hew({"export", out, "--step", "-q"}).exit_code, 0);
    const std::string assembly = out + "/step/assembly.step";
    const auto made = hew({"decompose", assembly, "--body", "P02", "--machine", "prusa-mk3s", "-o",
                           (dir / "again").string(), "--json"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(object_of(made)["parts"].size(), 1U);
    const auto wrong = hew({"decompose", assembly, "--body", "P99", "--machine", "prusa-mk3s", "-o",
                            (dir / "wrong").string(), "--json"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_EQ(object_of(wrong)["error"]["code"], "brep.no_such_body");
}

TEST(Export, MoreFacesThanCadProgramsBearAreRefused) {
    const TempDir dir;
    TriMesh egg = sphere(40, 130, 64);
    for (Eigen::Vector3d& p : egg.points) {
        p = Eigen::Vector3d(p.x(), 0.8 * p.y() + 0.05 * p.z(), 0.9 * p.z());
    }
    const std::string model = write_stl(dir, "egg.stl", egg);
    const std::string out = (dir / "out").string();
    ASSERT_EQ(hew({"decompose", model, "--machine", "prusa-mk3s", "-o", out, "-q"}).exit_code, 0);
    const auto refused = hew({"export", out, "--step", "--step-tol", "0.0001mm", "--json"});
    EXPECT_EQ(refused.exit_code, 4);
    EXPECT_EQ(object_of(refused)["error"]["code"], "solid.too_many_faces");
    EXPECT_EQ(hew({"inspect", out + "/parts/P01.ply", "-q"}).exit_code, 0) << "the job is whole";
    EXPECT_EQ(hew({"export", out, "--step", "--step-tol", "0.0001mm", "--force", "-q"}).exit_code,
              0);
}

TEST(Export, ItMustBeToldWhat) {
    const TempDir dir;
    EXPECT_EQ(hew({"export", dir.path().string()}).exit_code, 2);
    EXPECT_EQ(hew({"export", dir.path().string(), "--step"}).exit_code, 3);
}

}  // namespace
