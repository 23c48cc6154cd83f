// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/read_mill.h"

#include "decomp/base/file.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using cam::profile::list_mills;
using cam::profile::list_tools;
using cam::profile::read_mill_setup;
using cam::profile::read_tool;

TEST(MillProfile, EveryShippedMillReadsWithItsTools) {
    ASSERT_GE(list_mills().size(), 3U);
    for (const std::string& name : list_mills()) {
        const auto setup = read_mill_setup(name);
        ASSERT_TRUE(setup) << setup.error().text();
        EXPECT_FALSE(setup->tools.empty()) << name;
        EXPECT_EQ(setup->hash.size(), 64U);
        EXPECT_FALSE(cam::profile::explain(*setup).empty());
    }
}

TEST(MillProfile, EveryShippedToolIsSoundAndNumberedOnce) {
    std::vector<int> numbers;
    for (const std::string& name : list_tools()) {
        const auto tool = read_tool(name);
        ASSERT_TRUE(tool) << tool.error().text();
        EXPECT_EQ(tool->name, name);
        EXPECT_EQ(std::count(numbers.begin(), numbers.end(), tool->number), 0) << name;
        numbers.push_back(tool->number);
    }
    EXPECT_GE(numbers.size(), 8U);
}

TEST(MillProfile, AToolIsWhatItsFileSays) {
    const auto tool = read_tool("bull-6-r1").value();
    EXPECT_EQ(tool.shape, cam::tool::Shape::BullNose);
    EXPECT_EQ(tool.diameter_mm, 6);
    EXPECT_EQ(tool.corner_radius_mm, 1);
    ASSERT_EQ(tool.holder.size(), 3U);
    EXPECT_EQ(tool.holder[0].upper_diameter_mm, 19);
}

TEST(MillProfile, ChosenToolsReplaceTheMachinesOwnAndChangeTheHash) {
    const auto own = read_mill_setup("linuxcnc-router-4axis").value();
    const auto chosen = read_mill_setup("linuxcnc-router-4axis", {"ball-6"}).value();
    ASSERT_EQ(chosen.tools.size(), 1U);
    EXPECT_EQ(chosen.tools[0].name, "ball-6");
    EXPECT_NE(own.hash, chosen.hash);
    EXPECT_TRUE(own.machine.has_rotary());
    EXPECT_FALSE(read_mill_setup("linuxcnc-router-3axis")->machine.has_rotary());
}

TEST(MillProfile, ASettingChangesOneValue) {
    const auto setup = read_mill_setup("genmitsu-3018", {}, {"reach.cell_mm=0.05"});
    ASSERT_TRUE(setup) << setup.error().text();
    EXPECT_EQ(setup->machine.reach.cell_mm, 0.05);
}

TEST(MillProfile, MistakesAreNamedWithTheNearestName) {
    EXPECT_EQ(read_tool("bal-3").error().code, "profile.not_found");
    EXPECT_NE(read_tool("bal-3").error().hint.find("ball-3"), std::string::npos);
    EXPECT_EQ(read_mill_setup("genmitsu-3018", {}, {"reach.cell=1"}).error().code,
              "profile.unknown_key");
    EXPECT_EQ(read_mill_setup("genmitsu-3018", {}, {"reach.tolerance_mm=0.01"}).error().code,
              "profile.inconsistent");
}

TEST(MillProfile, EveryShippedMillNamesItsSourcesAndItsController) {
    for (const std::string& name : list_mills()) {
        const auto setup = read_mill_setup(name).value();
        EXPECT_FALSE(setup.machine.sources.empty()) << name;
        EXPECT_EQ(setup.dialect.name, setup.machine.dialect);
        EXPECT_FALSE(setup.dialect.sources.empty()) << setup.dialect.name;
    }
    EXPECT_EQ(cam::profile::list_mill_dialects(),
              (std::vector<std::string>{"carvera", "fluidnc", "grbl", "grblhal", "linuxcnc", "mach",
                                        "marlin-mill", "roland-nc"}));
}

TEST(MillProfile, AMachineWithMoreAxesThanItsDialectIsRefused) {
    for (const char* dialect : {"grbl", "marlin-mill"}) {
        const auto refused = read_mill_setup("linuxcnc-router-4axis", {},
                                             {std::string("machine.dialect=") + dialect});
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, "profile.inconsistent");
        EXPECT_NE(refused.error().message.find("axis A"), std::string::npos);
        EXPECT_TRUE(read_mill_setup("linuxcnc-router-3axis", {},
                                    {std::string("machine.dialect=") + dialect}));
    }
}

TEST(MillProfile, AnotherDialectIsAnotherSetup) {
    const auto own = read_mill_setup("linuxcnc-router-3axis").value();
    const auto other =
        read_mill_setup("linuxcnc-router-3axis", {}, {"machine.dialect=grblhal"}).value();
    EXPECT_EQ(other.dialect.end.substr(0, 3), "M30");
    EXPECT_NE(own.hash, other.hash);
    EXPECT_FALSE(
        read_mill_setup("linuxcnc-router-3axis", {}, {"milling.arcs=false"})->dialect.arcs);
}

TEST(MillProfile, ADialectDoesNotWriteWhatItForbids) {
    const auto refused = read_mill_setup("linuxcnc-router-3axis", {}, {"milling.end=G20 M2"});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("G20"), std::string::npos);
    EXPECT_EQ(
        read_mill_setup("linuxcnc-router-3axis", {}, {"milling.dwell=G4 P{second}"}).error().code,
        "profile.inconsistent");
}

TEST(MillProfile, EveryShippedMaterialNamesSourceAndLicenceOfItsValues) {
    const std::vector<std::string> names = cam::profile::list_mill_materials();
    EXPECT_EQ(names, (std::vector<std::string>{"acrylic", "aluminium-6061", "brass", "foam", "mdf",
                                               "pine", "plywood"}));
    for (const std::string& name : names) {
        const auto material = cam::profile::read_mill_material(name);
        ASSERT_TRUE(material) << material.error().text();
        EXPECT_GE(material->sources.size(), 3U) << name;
    }
    EXPECT_EQ(cam::profile::read_mill_material("pin").error().code, "profile.not_found");
    EXPECT_EQ(cam::profile::read_mill_material("pine", {"milling.coolant=tea"}).error().code,
              "profile.inconsistent");
}

TEST(MillProfile, AToolThatContradictsItselfIsRefused) {
    const tests::TempDir folder;
    const auto path = folder / "blunt.toml";
    const auto put = [&](const std::string& lines) {
        ASSERT_TRUE(decomp::write_file(path,
                                       "schema = 1\n[tool]\ntitle = \"t\"\nnumber = 1\n" + lines,
                                       decomp::Overwrite::Allow));
    };
    put("shape = \"ball\"\ndiameter_mm = 6\nflute_mm = 2\nshank_diameter_mm = 6\n"
        "stickout_mm = 30\n");
    EXPECT_EQ(read_tool(path.string()).error().code, "profile.inconsistent");
    put("shape = \"cube\"\ndiameter_mm = 6\nflute_mm = 20\nshank_diameter_mm = 6\n"
        "stickout_mm = 30\n");
    EXPECT_EQ(read_tool(path.string()).error().code, "profile.inconsistent");
    put("shape = \"ball\"\ndiameter_mm = 6\nflute_mm = 20\nshank_diameter_mm = 6\n"
        "stickout_mm = 30\n[holder]\nlower_diameters_mm = [20, 30]\nlengths_mm = [5]\n");
    EXPECT_EQ(read_tool(path.string()).error().code, "profile.inconsistent");
    put("shape = \"ball\"\ndiameter_mm = 6\nflute_mm = 20\nshank_diameter_mm = 6\n"
        "stickout_mm = 30\n[holder]\nlower_diameters_mm = 20\n");
    EXPECT_EQ(read_tool(path.string()).error().code, "profile.wrong_type");
}

}  // namespace
