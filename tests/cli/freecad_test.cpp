// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/hew.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

/// FreeCAD as somebody else's program: it makes what Hew reads and reads what Hew makes. It shares
/// the geometry kernel, so measures are compared as well.
namespace {

using namespace tests;

constexpr const char* kFreecad = "/usr/bin/freecadcmd";
constexpr double kInch = 25.4;

/// Runs a script of tests/support with FreeCAD; `files` one a line.
std::string run_freecad(const std::string& script, const std::string& files) {
    ::setenv("HEW_STEP_FILES", files.c_str(), 1);
    const Finished finished =
        run_program({kFreecad, std::string(HEW_SOURCE_DIR) + "/tests/support/" + script});
    ::unsetenv("HEW_STEP_FILES");
    return finished.out;
}

std::vector<Json> judged(const std::string& files) {
    std::istringstream lines(run_freecad("judge_step.py", files));
    std::vector<Json> out;
    for (std::string line; std::getline(lines, line);) {
        if (const auto at = line.find("judged "); at != std::string::npos) {
            out.push_back(Json::parse(line.substr(at + 7)));
        }
    }
    return out;
}

TEST(Freecad, APlateInInchesIsCutAndComesBackWithItsDimensions) {
    if (!fs::exists(kFreecad)) {
        GTEST_SKIP() << "no freecadcmd";
    }
    const TempDir dir;
    const std::string model = (dir / "plate.step").string();
    run_freecad("inch_plate.py", model);
    ASSERT_TRUE(fs::exists(model));
    const Json read = object_of(hew({"inspect", model, "--json"}));
    const double volume = read["bodies"][0]["volume_mm3"];
    const std::string out = (dir / "out").string();
    ASSERT_EQ(hew({"decompose", model, "--machine", "prusa-mk3s", "-o", out, "-q"}).exit_code, 0);
    const Finished exported = hew({"export", out, "--step", "--json"});
    ASSERT_EQ(exported.exit_code, 0) << exported.err;
    const Json json = object_of(exported);
    std::string files = json["assembly"];
    for (const Json& part : json["parts"]) {
        files += "\n" + part["file"].get<std::string>();
    }
    const auto verdicts = judged(files);
    ASSERT_EQ(verdicts.size(), 1 + json["parts"].size());
    for (const Json& verdict : verdicts) {
        EXPECT_TRUE(verdict["valid"]) << verdict;
        EXPECT_TRUE(verdict["closed"]) << verdict;
        EXPECT_LE(verdict["cpu_s"].get<double>(), 10) << verdict;
    }
    EXPECT_EQ(verdicts[0]["solids"], json["parts"].size());
    double of_parts = 0;
    for (std::size_t i = 0; i < json["parts"].size(); ++i) {
        EXPECT_EQ(verdicts[i + 1]["type"], "Solid");
        const double part_mm3 = json["parts"][i]["volume_mm3"];
        EXPECT_NEAR(verdicts[i + 1]["volume_mm3"].get<double>(), part_mm3, 1e-9 * part_mm3);
        of_parts += part_mm3;
    }
    // Rounded corners stay chords of at most the default deflection.
    EXPECT_NEAR(of_parts, volume, 1e-4 * volume);
    EXPECT_NEAR(verdicts[0]["size_mm"][0].get<double>(), 14 * kInch, 1e-6);
    EXPECT_NEAR(verdicts[0]["size_mm"][1].get<double>(), 8 * kInch, 1e-6);
    EXPECT_NEAR(verdicts[0]["size_mm"][2].get<double>(), 0.75 * kInch, 1e-6);
    int holes = 0;
    int corners = 0;
    int edges = 0;
    for (const double radius : verdicts[0]["cylinder_radii_mm"]) {
        holes += std::abs(radius - 0.3125 * kInch) <= 1e-6 ? 1 : 0;
        corners += std::abs(radius - 1.125 * kInch) <= 1e-6 ? 1 : 0;
        edges += std::abs(radius - 0.125 * kInch) <= 1e-6 ? 1 : 0;
    }
    EXPECT_EQ(holes, 8);
    EXPECT_EQ(corners, 4);
    EXPECT_GE(edges, 4);
    EXPECT_EQ(static_cast<std::size_t>(holes + corners + edges),
              verdicts[0]["cylinder_radii_mm"].size())
        << "nothing else is taken for a cylinder";
}

}  // namespace
