// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/read_brep.h"

#include "decomp/io/read_mesh.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/unit/decomp/brep/solids.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using decomp::brep::BrepReadOptions;
using decomp::brep::read_brep;
using std::numbers::pi;

constexpr double kBlockMm3 = 100 * 60 * 20 - pi * 8 * 8 * 20;

std::vector<decomp::brep::Body> bodies_of(const std::string& bytes,
                                          const BrepReadOptions& options = {.measured = true}) {
    auto bodies = read_brep(bytes, "test.step", options, decomp::Run{});
    EXPECT_TRUE(bodies) << (bodies ? "" : bodies.error().text());
    return bodies ? *bodies : std::vector<decomp::brep::Body>{};
}

std::string code_of(const std::string& bytes, const BrepReadOptions& options = {}) {
    const auto bodies = read_brep(bytes, "test.step", options, decomp::Run{});
    return bodies ? "" : bodies.error().code;
}

// First in the file: whatever runs before it may have loaded the kernel.
TEST(Brep, TheKernelIsLoadedOnlyWhenASolidFileIsMet) {
    EXPECT_FALSE(decomp::brep::kind_of("solid ascii\n"));
    EXPECT_EQ(code_of("ISO-10303-21;\nHEADER;"), "brep.truncated");
    void* kernel = ::dlopen("hew_occt.so", RTLD_NOW | RTLD_NOLOAD);
    EXPECT_EQ(kernel, nullptr);
}

class Units : public testing::TestWithParam<const char*> {};

TEST_P(Units, EveryUnitBecomesMillimetres) {
    const auto bodies = bodies_of(tests::holed_block_step(GetParam(), "AP214IS"));
    ASSERT_EQ(bodies.size(), 1);
    const auto& figures = bodies[0].figures;
    EXPECT_TRUE(figures.valid && figures.closed);
    EXPECT_EQ(figures.faces, 7);
    EXPECT_EQ(figures.planes, 6);
    ASSERT_EQ(figures.cylinder_radii_mm.size(), 1);
    EXPECT_NEAR(figures.cylinder_radii_mm[0], 8, 1e-9);
    EXPECT_NEAR(figures.volume_mm3, kBlockMm3, 1e-9 * kBlockMm3);
    EXPECT_NEAR((figures.max_mm - figures.min_mm - Eigen::Vector3d(100, 60, 20)).norm(), 0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Brep, Units, testing::Values("MM", "INCH", "M"),
                         [](const auto& tested) { return std::string(tested.param); });

class Schemas : public testing::TestWithParam<const char*> {};

TEST_P(Schemas, EverySchemaIsRead) {
    const auto bodies = bodies_of(tests::holed_block_step("MM", GetParam()));
    ASSERT_EQ(bodies.size(), 1);
    EXPECT_NEAR(bodies[0].figures.volume_mm3, kBlockMm3, 1e-9 * kBlockMm3);
}

INSTANTIATE_TEST_SUITE_P(Brep, Schemas, testing::Values("AP203", "AP214IS", "AP242DIS"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(Brep, CascadeFilesAreReadToo) {
    const auto bodies = bodies_of(tests::holed_block_brep());
    ASSERT_EQ(bodies.size(), 1);
    EXPECT_EQ(bodies[0].name, "body 1");
    EXPECT_NEAR(bodies[0].figures.volume_mm3, kBlockMm3, 1e-9 * kBlockMm3);
}

TEST(Brep, TrianglesOfNeighbouringFacesShareTheirPoints) {
    for (const double deflection_mm : {0.5, 0.1, 0.02}) {
        const auto bodies =
            bodies_of(tests::rounded_plate_step(), {.deflection_mm = deflection_mm});
        ASSERT_EQ(bodies.size(), 1);
        const auto topology = decomp::mesh::check_topology(bodies[0].mesh);
        EXPECT_TRUE(topology.manifold()) << "deflection " << deflection_mm;
        EXPECT_EQ(topology.components, 1);
        EXPECT_EQ(topology.euler_characteristic, 2 - 2 * 4) << "four holes: genus 4";
    }
}

TEST(Brep, TheMeshComesNearTheSolidAsTheDeflectionShrinks) {
    // A chord of sagitta s in a hole of radius 8 loses at most 2/3 s of area per length.
    for (const double deflection_mm : {0.2, 0.02}) {
        const auto bodies = bodies_of(tests::holed_block_step("MM", "AP214IS"),
                                      {.deflection_mm = deflection_mm, .angle = 1});
        ASSERT_EQ(bodies.size(), 1);
        const double excess = decomp::mesh::volume_mm3(bodies[0].mesh) - kBlockMm3;
        EXPECT_GT(excess, 0);
        EXPECT_LT(excess, 2.0 / 3 * deflection_mm * 2 * pi * 8 * 20);
    }
}

TEST(Brep, AssembliesKeepNamesColoursAndPlaces) {
    const auto bodies = bodies_of(tests::assembly_step());
    ASSERT_EQ(bodies.size(), 3);
    EXPECT_EQ(bodies[0].name, "base");
    EXPECT_EQ(bodies[1].name, "pin");
    EXPECT_EQ(bodies[2].name, "pin (2)");
    ASSERT_TRUE(bodies[0].colour && bodies[1].colour && bodies[2].colour);
    EXPECT_NEAR((*bodies[0].colour)[0], 1, 1e-6);
    EXPECT_NEAR((*bodies[0].colour)[2], 0, 1e-6);
    EXPECT_NEAR((*bodies[2].colour)[2], 1, 1e-6);
    // The second pin lies along -Y: turned by 90 degrees about X.
    EXPECT_NEAR((bodies[1].figures.min_mm - Eigen::Vector3d(18, -2, 0)).norm(), 0, 1e-6);
    EXPECT_NEAR((bodies[2].figures.min_mm - Eigen::Vector3d(38, -8, -2)).norm(), 0, 1e-6);
    EXPECT_NEAR((bodies[2].figures.max_mm - Eigen::Vector3d(42, 0, 2)).norm(), 0, 1e-6);
    EXPECT_NEAR(bodies[2].figures.volume_mm3, pi * 4 * 8, 1e-6);
    EXPECT_GT(decomp::mesh::volume_mm3(bodies[2].mesh), 0) << "outward after turning";
}

TEST(Brep, OneBodyCanBeChosenByName) {
    const std::string file = tests::assembly_step();
    const auto bodies = bodies_of(file, {.body = "pin (2)"});
    ASSERT_EQ(bodies.size(), 1);
    EXPECT_NEAR(decomp::mesh::bounds(bodies[0].mesh).min().x(), 38, 0.01);
    const auto wrong = read_brep(file, "test.step", {.body = "pim"}, decomp::Run{});
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().code, "brep.no_such_body");
    EXPECT_NE(wrong.error().hint.find("did you mean 'pin'"), std::string::npos)
        << wrong.error().hint;
}

TEST(Brep, WhatIsNoSolidIsRefused) {
    EXPECT_EQ(code_of(tests::sheet_step()), "brep.no_solid");
    EXPECT_EQ(code_of(tests::wire_step()), "brep.no_solid");
}

TEST(Brep, ASheetBesideASolidIsLeftOutWithAWarning) {
    decomp::Run run;
    std::string warning;
    run.log_sink = [&](const decomp::LogEvent& event) { warning += event.text; };
    const auto bodies = read_brep(tests::mixed_step(), "test.step", {}, run);
    ASSERT_TRUE(bodies);
    EXPECT_EQ(bodies->size(), 1);
    EXPECT_NE(warning.find("1 faces of open sheets"), std::string::npos) << warning;
}

TEST(Brep, FilesThatEndTooEarlyAreErrorsWhereverTheyEnd) {
    const std::string step = tests::rounded_plate_step();
    const std::string brep = tests::holed_block_brep();
    for (int k = 1; k < 12; ++k) {
        EXPECT_EQ(code_of(step.substr(0, step.size() * static_cast<std::size_t>(k) / 12)),
                  "brep.truncated");
        EXPECT_EQ(code_of(brep.substr(0, brep.size() * static_cast<std::size_t>(k) / 12)),
                  "brep.truncated");
    }
    // An end mark after a torn middle, as a mail gateway might leave it.
    for (int k = 2; k < 12; ++k) {
        const std::string torn = step.substr(0, step.size() * static_cast<std::size_t>(k) / 12) +
                                 "\nENDSEC;\nEND-ISO-10303-21;\n";
        const std::string code = code_of(torn);
        EXPECT_TRUE(code == "brep.truncated" || code == "brep.unreadable")
            << "cut at " << k << " twelfths: '" << code << "'";
    }
}

TEST(Brep, MissingEntitiesAreNamedWithTheirLine) {
    std::string step = tests::holed_block_step("MM", "AP214IS");
    const std::size_t shell = step.find("CLOSED_SHELL('',(#");
    ASSERT_NE(shell, std::string::npos);
    step.insert(shell + 18, "99");
    const auto bodies = read_brep(step, "test.step", {}, decomp::Run{});
    ASSERT_FALSE(bodies);
    EXPECT_EQ(bodies.error().code, "brep.unreadable");
    EXPECT_TRUE(bodies.error().where.starts_with("test.step:")) << bodies.error().where;
}

TEST(Brep, EmptyFilesAreErrors) {
    EXPECT_EQ(code_of("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"),
              "brep.unreadable");
    EXPECT_EQ(code_of(""), "brep.unreadable");
}

TEST(Brep, TheSameFileGivesTheSameTriangles) {
    const std::string file = tests::rounded_plate_step();
    const auto first = bodies_of(file, {});
    const auto second = bodies_of(file, {});
    ASSERT_EQ(first.size(), second.size());
    EXPECT_EQ(first[0].mesh.triangles, second[0].mesh.triangles);
    EXPECT_EQ(first[0].mesh.points, second[0].mesh.points);
}

TEST(Brep, EveryVerbsReaderTakesStep) {
    const std::string inches = tests::holed_block_step("INCH", "AP214IS");
    const auto mesh = decomp::io::parse_mesh(inches, "block.stp", {.scale = 2}, decomp::Run{});
    ASSERT_TRUE(mesh);
    EXPECT_NEAR(decomp::mesh::bounds(*mesh).sizes().x(), 200, 1e-6);
    const auto unit = decomp::io::parse_mesh(inches, "block.stp", {.unit = "in"}, decomp::Run{});
    ASSERT_FALSE(unit);
    EXPECT_EQ(unit.error().code, "io.unit");
    const auto brep = decomp::io::parse_mesh(tests::holed_block_brep(), "block.brep",
                                             {.unit = "cm"}, decomp::Run{});
    ASSERT_TRUE(brep);
    EXPECT_NEAR(decomp::mesh::bounds(*brep).sizes().x(), 1000, 1e-6);
}

TEST(Brep, OptionsOfSolidsAreRefusedForMeshes) {
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const auto mesh = decomp::io::parse_mesh(obj, "a.obj", {.body = "base"}, decomp::Run{});
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, "io.not_a_solid_model");
}

}  // namespace
