// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/package_census.h"

#include "decomp/io/read_mesh.h"
#include "decomp/io/write_3mf.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"
#include "tests/support/zip.h"

#include <gtest/gtest.h>

#include <string>

namespace {

using decomp::io::count_package;

constexpr const char* kHead =
    R"(<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" xml:lang="en-US" )"
    R"(xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>)";
constexpr const char* kTetrahedron =
    R"(<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>)"
    R"(<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices><triangles>)"
    R"(<triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/><triangle v1="0" v2="3" v3="2"/>)"
    R"(<triangle v1="1" v2="2" v3="3"/></triangles></mesh></object>)";

std::string package(const std::string& model,
                    tests::ZipPacking packing = tests::ZipPacking::Deflated) {
    return tests::zip(
        {{"[Content_Types].xml",
          R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">)"
          R"(<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>)"
          R"(<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)"},
         {"_rels/.rels",
          R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
          R"(<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)"},
         {"3D/3dmodel.model", model}},
        packing);
}

/// Objects 2 … levels + 1, each of two components: the one before, twice.
std::string doubling(int levels) {
    std::string model = std::string(kHead) + kTetrahedron;
    for (int id = 2; id <= levels + 1; ++id) {
        const std::string below = R"(<component objectid=")" + std::to_string(id - 1) + R"("/>)";
        model += R"(<object id=")" + std::to_string(id) + R"(" type="model"><components>)" + below +
                 below + "</components></object>";
    }
    return model + R"(</resources><build><item objectid=")" + std::to_string(levels + 1) +
           R"("/></build></model>)";
}

TEST(CountPackage, CountsInstancesThroughNestedComponents) {
    for (const auto packing : {tests::ZipPacking::Stored, tests::ZipPacking::Deflated}) {
        const auto census = count_package(package(doubling(4), packing), "a.3mf");
        ASSERT_TRUE(census) << census.error().text();
        EXPECT_EQ(census->instances, 1U + 2 + 4 + 8 + 16);
        EXPECT_GT(census->unpacked_bytes, doubling(4).size());
    }
}

TEST(CountPackage, AgreesWithTheReaderOnWhatItLetsThrough) {
    const auto mesh = decomp::io::parse_mesh(package(doubling(3)), "a.3mf", {}, decomp::Run{});
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_EQ(mesh->triangles.size(), 8U * 4);
}

TEST(CountPackage, ComponentsThatDoubleAreRefusedBeforeTheyAreRead) {
    for (const int levels : {17, 25, 31}) {
        const auto mesh =
            decomp::io::parse_mesh(package(doubling(levels)), "a.3mf", {}, decomp::Run{});
        ASSERT_FALSE(mesh);
        EXPECT_EQ(mesh.error().code, "io.too_large");
    }
}

TEST(CountPackage, DeepNestingAndCirclesAreRefused) {
    const auto deep = count_package(package(doubling(40)), "a.3mf");
    ASSERT_FALSE(deep);
    EXPECT_EQ(deep.error().code, "io.threemf");
    const auto circle = count_package(
        package(
            std::string(kHead) +
            R"(<object id="2" type="model"><components><component objectid="3"/></components></object>)"
            R"(<object id="3" type="model"><components><component objectid="2"/></components></object>)"
            R"(</resources><build><item objectid="3"/></build></model>)"),
        "a.3mf");
    ASSERT_FALSE(circle);
    EXPECT_EQ(circle.error().code, "io.threemf");
}

TEST(CountPackage, AnEntryLargerThanItStatesIsRefused) {
    std::string bytes = package(doubling(4));
    const std::size_t last = bytes.rfind("PK\x01\x02");
    ASSERT_NE(last, std::string::npos);
    bytes.replace(last + 24, 4, std::string("\x10\0\0\0", 4));  // 16 bytes, says the directory
    const auto census = count_package(bytes, "a.3mf");
    ASSERT_FALSE(census);
    EXPECT_EQ(census.error().code, "io.threemf");
}

TEST(CountPackage, ADocumentTypeIsRefused) {
    const auto census = count_package(
        package(R"(<?xml version="1.0"?><!DOCTYPE model [<!ENTITY a "aaaa">]><model/>)"), "a.3mf");
    ASSERT_FALSE(census);
    EXPECT_EQ(census.error().code, "io.threemf");
}

TEST(CountPackage, OurOwnPackagesPass) {
    const auto bytes = decomp::io::threemf_bytes({{"P01", tests::box({0, 0, 0}, {1, 2, 3})}});
    ASSERT_TRUE(bytes);
    const auto census = count_package(*bytes, "a.3mf");
    ASSERT_TRUE(census) << census.error().text();
    EXPECT_EQ(census->instances, 1U);
}

}  // namespace
