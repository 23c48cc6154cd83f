// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/read_profile.h"

#include "cam/profile/read_mill.h"
#include "decomp/base/file.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using cam::profile::FdmSetup;
using cam::profile::read_fdm_setup;
namespace fs = std::filesystem;

/// A private copy of the shipped profiles, to be spoilt.
class SpoiltProfile : public testing::Test {
  protected:
    void SetUp() override {
        fs::copy(fs::path(HEW_SOURCE_DIR) / "machine_profiles", folder_ / "p",
                 fs::copy_options::recursive);
    }

    [[nodiscard]] std::string machine() const {
        return (folder_ / "p/fdm/prusa-mk3s.toml").string();
    }

    void replace(const std::string& file, const std::string& from, const std::string& to) const {
        const fs::path path = folder_ / ("p/" + file);
        std::string text = decomp::read_file(path).value();
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
        ASSERT_TRUE(decomp::write_file(path, text, decomp::Overwrite::Allow));
    }

    [[nodiscard]] decomp::Error error(const std::vector<std::string>& settings = {}) const {
        const auto setup = read_fdm_setup(machine(), "", settings);
        return setup ? decomp::Error{} : setup.error();
    }

    tests::TempDir folder_;
};

TEST(Profile, EveryShippedMachineReadsWithEveryShippedMaterial) {
    const fs::path root = fs::path(HEW_SOURCE_DIR) / "machine_profiles";
    int read = 0;
    for (const auto& machine : fs::directory_iterator(root / "fdm")) {
        for (const auto& material : fs::directory_iterator(root / "materials")) {
            if (cam::profile::read_mill_material(material.path().string())) {
                continue;  // stock for mills
            }
            const auto setup = read_fdm_setup(machine.path().string(), material.path().string());
            ASSERT_TRUE(setup) << setup.error().text();
            EXPECT_EQ(setup->hash.size(), 64U);
            ++read;
        }
    }
    EXPECT_GE(read, 6);
}

TEST(Profile, TheCreatorProIsWhatItsMakerSays) {
    const auto setup = read_fdm_setup("flashforge-creator-pro");
    ASSERT_TRUE(setup) << setup.error().text();
    const auto& chamber = setup->machine.chamber;
    EXPECT_EQ(chamber.max_mm - chamber.min_mm, Eigen::Vector3d(227, 148, 150));
    EXPECT_EQ((chamber.max_mm + chamber.min_mm).head<2>(), Eigen::Vector2d::Zero());
    EXPECT_EQ(setup->machine.converter.program, "gpx");
    const auto& forbidden = setup->dialect.forbidden;
    EXPECT_NE(std::find(forbidden.begin(), forbidden.end(), "M109"), forbidden.end());
    EXPECT_EQ(setup->material.name, "pla");
}

TEST(Profile, MachinesAreListedSorted) {
    const std::vector<std::string> names = cam::profile::list_machines();
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
    EXPECT_NE(std::find(names.begin(), names.end(), "prusa-mk3s"), names.end());
}

TEST(Profile, AMisspeltMachineOrMaterialComesWithTheNearestName) {
    const auto machine = read_fdm_setup("prusa-mk3");
    ASSERT_FALSE(machine);
    EXPECT_EQ(machine.error().code, "profile.not_found");
    EXPECT_EQ(machine.error().hint, "did you mean 'prusa-mk3s'?");
    const auto material = read_fdm_setup("prusa-mk3s", "petgg");
    ASSERT_FALSE(material);
    EXPECT_EQ(material.error().hint, "did you mean 'petg'?");
}

TEST(Profile, SettingsOverrideAndChangeTheHash) {
    const auto plain = read_fdm_setup("prusa-mk3s").value();
    const auto changed =
        read_fdm_setup("prusa-mk3s", "petg",
                       {"process.layer_height_mm=0.15", "process.infill_angle_deg=30",
                        "material.fan_fraction=0.25", "motion.jerk_mm_per_s=[9, 9, 1, 5]",
                        "machine.title=Mine", "dialect.relative_e=false"});
    ASSERT_TRUE(changed) << changed.error().text();
    EXPECT_EQ(changed->machine.process.layer_height_mm, 0.15);
    EXPECT_NEAR(changed->machine.process.infill_angle.degrees(), 30, 1e-12);
    EXPECT_EQ(changed->material.name, "petg");
    EXPECT_EQ(changed->material.fan_fraction, 0.25);
    EXPECT_EQ(changed->machine.motion.jerk_mm_per_s, Eigen::Vector4d(9, 9, 1, 5));
    EXPECT_EQ(changed->machine.title, "Mine");
    EXPECT_FALSE(changed->dialect.relative_e);
    EXPECT_NE(changed->hash, plain.hash);
    EXPECT_EQ(read_fdm_setup("prusa-mk3s")->hash, plain.hash);
}

TEST(Profile, BadSettingsAreRefused) {
    const auto code = [](const std::string& setting) {
        const auto setup = read_fdm_setup("prusa-mk3s", "", {setting});
        return setup ? std::string() : setup.error().code;
    };
    EXPECT_EQ(code("process.layer_height_mm"), "profile.bad_setting");
    EXPECT_EQ(code("process.layer_height_mm=thin"), "profile.wrong_type");
    EXPECT_EQ(code("process.layer_height_mm=1.6"), "profile.out_of_range");
    EXPECT_EQ(code("process.layer_height_mm=nan"), "profile.out_of_range");
    EXPECT_EQ(code("process.perimeters=2.5"), "profile.out_of_range");
    EXPECT_EQ(code("process.layer_height_mm=0.5"), "profile.inconsistent");
    EXPECT_EQ(code("dialect.relative_e=yes"), "profile.wrong_type");
    const auto unknown = read_fdm_setup("prusa-mk3s", "", {"process.layer_hight_mm=0.2"});
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().hint, "did you mean 'process.layer_height_mm'?");
}

TEST_F(SpoiltProfile, AnUnknownKeyIsToldWithFileLineColumnAndNearestName) {
    replace("fdm/prusa-mk3s.toml", "margin_mm = 2", "margn_mm = 2");
    const decomp::Error fault = error();
    EXPECT_EQ(fault.code, "profile.unknown_key");
    EXPECT_EQ(fault.message, "unknown key 'margn_mm' in [chamber]");
    EXPECT_EQ(fault.hint, "did you mean 'margin_mm'?");
    EXPECT_EQ(fault.where, machine() + ":12:1");
}

TEST_F(SpoiltProfile, AllFaultsOfAFileAreToldAtOnce) {
    replace("fdm/prusa-mk3s.toml", "schema = 1", "schema = 2");
    replace("fdm/prusa-mk3s.toml", "title = \"Prusa i3 MK3S\"", "title = 7");
    replace("fdm/prusa-mk3s.toml", "diameter_mm = 0.4", "diameter_mm = 40");
    replace("fdm/prusa-mk3s.toml", "max_flow_mm3_per_s = 11.5\n", "");
    replace("fdm/prusa-mk3s.toml", "[retraction]", "[retracton]");
    const decomp::Error fault = error();
    EXPECT_EQ(fault.code, "profile.schema");
    // retraction is unknown, and so its two required keys are missing
    EXPECT_EQ(fault.notes.size(), 6U);
}

TEST_F(SpoiltProfile, BrokenTomlIsASyntaxErrorWithItsPlace) {
    replace("materials/pla.toml", "title = \"PLA\"", "title = \"PLA");
    const decomp::Error fault = error();
    EXPECT_EQ(fault.code, "profile.syntax");
    EXPECT_NE(fault.where.find("pla.toml:4:"), std::string::npos) << fault.where;
}

TEST_F(SpoiltProfile, ATemplateWithAnUnknownNameIsRefused) {
    replace("fdm/prusa-mk3s.toml", "M140 S{bed_celsius}", "M140 S{bed_celcius}");
    const decomp::Error fault = error();
    EXPECT_EQ(fault.code, "profile.inconsistent");
    EXPECT_NE(fault.message.find("bed_celsius"), std::string::npos) << fault.message;
}

TEST_F(SpoiltProfile, AMachineWhoseTemplatesItsDialectForbidsIsRefused) {
    replace("fdm/prusa-mk3s.toml", "dialect = \"marlin\"", "dialect = \"sailfish\"");
    const decomp::Error fault = error();
    EXPECT_EQ(fault.code, "profile.inconsistent");
    EXPECT_NE(fault.text().find("M109"), std::string::npos);
}

TEST_F(SpoiltProfile, AMachineWhoseDialectHasTooFewAxesIsRefused) {
    replace("dialects/marlin.toml", "max_axes = \"XYZE\"", "max_axes = \"XYZ\"");
    EXPECT_EQ(error().code, "profile.inconsistent");
}

TEST_F(SpoiltProfile, AMaterialTooHotForTheMachineIsRefused) {
    replace("fdm/prusa-mk3s.toml", "max_nozzle_celsius = 300", "max_nozzle_celsius = 200");
    EXPECT_EQ(error().code, "profile.inconsistent");
    EXPECT_EQ(error({"heaters.max_nozzle_celsius=250"}).code, "");
}

TEST(Profile, ExplainShowsEveryValue) {
    const FdmSetup setup = read_fdm_setup("flashforge-creator-pro").value();
    const std::string text = cam::profile::explain(setup);
    for (const cam::profile::FieldRow& row : cam::profile::describe(setup)) {
        EXPECT_NE(text.find("  " + row.key + " = "), std::string::npos) << row.key;
    }
    EXPECT_NE(text.find("M133 T0"), std::string::npos);
}

}  // namespace
