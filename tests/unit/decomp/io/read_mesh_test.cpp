// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/read_mesh.h"

#include "decomp/io/write_mesh.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>

namespace {

using decomp::Result;
using decomp::io::parse_mesh;
using decomp::mesh::TriMesh;

Result<TriMesh> parse(std::string_view bytes, std::string_view name) {
    return parse_mesh(bytes, name, {}, decomp::Run{});
}

void expect_box_of_volume(const Result<TriMesh>& mesh, double volume) {
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_TRUE(decomp::mesh::check_topology(*mesh).manifold());
    EXPECT_EQ(mesh->points.size(), 8U);
    EXPECT_EQ(mesh->triangles.size(), 12U);
    EXPECT_NEAR(decomp::mesh::volume_mm3(*mesh), volume, 1e-6 * volume);
}

void expect_error(const Result<TriMesh>& mesh, std::string_view code, std::string_view where) {
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, code);
    EXPECT_EQ(mesh.error().where, where);
}

constexpr const char* kBoxObj =
    "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nv 0 0 4\nv 2 0 4\nv 2 3 4\nv 0 3 4\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::string ascii_stl(const TriMesh& mesh) {
    std::string out = "solid box\n";
    for (const auto& t : mesh.triangles) {
        out += "facet normal 0 0 0\nouter loop\n";
        for (const auto corner : t) {
            const auto& p = mesh.points[corner];
            out += "vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
                   std::to_string(p.z()) + "\n";
        }
        out += "endloop\nendfacet\n";
    }
    return out + "endsolid box\n";
}

TEST(ReadStl, CornersOfABinaryFileAreMergedWhereTheirBytesAgree) {
    expect_box_of_volume(parse(decomp::io::stl_bytes(tests::box({0, 0, 0}, {2, 3, 4})), "a.stl"),
                         24);
}

TEST(ReadStl, ABinaryFileThatBeginsWithSolidIsStillBinary) {
    std::string bytes = decomp::io::stl_bytes(tests::box({0, 0, 0}, {2, 3, 4}));
    bytes.replace(0, 6, "solid ");
    expect_box_of_volume(parse(bytes, "a.stl"), 24);
}

TEST(ReadStl, AnAsciiFileGivesTheSameBox) {
    expect_box_of_volume(parse(ascii_stl(tests::box({0, 0, 0}, {2, 3, 4})), "a.stl"), 24);
}

TEST(ReadStl, NegativeZeroIsTheSamePointAsZero) {
    std::string text = ascii_stl(tests::box({0, 0, 0}, {2, 3, 4}));
    text.replace(text.find("0.000000"), 8, "-0.00000");
    expect_box_of_volume(parse(text, "a.stl"), 24);
}

TEST(ReadStl, AHeaderThatAnnouncesMoreFacetsThanTheFileHoldsIsTruncated) {
    std::string bytes = decomp::io::stl_bytes(tests::box({0, 0, 0}, {1, 1, 1}));
    bytes.resize(bytes.size() - 10);
    expect_error(parse(bytes, "a.stl"), "io.truncated", "a.stl: byte 674");
}

TEST(ReadStl, AHugeCountCostsNoMemory) {
    std::string bytes(200, '\0');
    const std::uint32_t count = 1'300'000'000;
    std::memcpy(bytes.data() + 80, &count, 4);
    expect_error(parse(bytes, "a.stl"), "io.truncated", "a.stl: byte 200");
}

TEST(ReadStl, ACornerThatIsNoNumberIsNamedByItsByte) {
    std::string bytes = decomp::io::stl_bytes(tests::box({0, 0, 0}, {1, 1, 1}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 84 + 50 + 12, &nan, 4);
    expect_error(parse(bytes, "a.stl"), "io.not_finite", "a.stl: byte 146");
}

TEST(ReadStl, AsciiThatEndsWithinAFacetIsTruncated) {
    expect_error(parse("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0", "a.stl"),
                 "io.truncated", "a.stl:4");
}

TEST(ReadObj, QuadsBecomeTriangles) { expect_box_of_volume(parse(kBoxObj, "a.obj"), 24); }

TEST(ReadObj, NegativeIndicesCountFromTheLastVertex) {
    std::string text = kBoxObj;
    text.resize(text.find('f'));
    text += "f -8 -5 -6 -7\nf 5/1/1 6//2 7/3 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 \\\n5 8\n";
    expect_box_of_volume(parse(text, "a.obj"), 24);
}

TEST(ReadObj, AConcavePolygonKeepsItsArea) {
    const auto mesh = parse("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n", "a.obj");
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->triangles.size(), 3U);
    EXPECT_NEAR(decomp::mesh::area_mm2(*mesh), 10, 1e-12);
}

TEST(ReadObj, AFaceThatNamesAVertexTooFarIsNamedByItsLine) {
    expect_error(parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a.obj"), "io.index_out_of_range",
                 "a.obj:4");
}

TEST(ReadObj, AFaceOfTwoCornersIsNoFace) {
    expect_error(parse("v 0 0 0\nv 1 0 0\nf 1 2\n", "a.obj"), "io.syntax", "a.obj:3");
}

TEST(ReadObj, ANumberTooLargeForADoubleIsNotFinite) {
    expect_error(parse("v 0 1e999 0\n", "a.obj"), "io.not_finite", "a.obj:1");
}

TEST(ReadOff, CommentsColoursAndBlankLinesAreSkipped) {
    const auto mesh = parse(
        "# made by hand\nOFF\n4 4 6\n\n0 0 0\n1 0 0 # a corner\n0 1 0\n0 0 1\n"
        "3 0 2 1 255 0 0\n3 0 1 3\n3 1 2 3\n3 2 0 3 0.5\n",
        "a.off");
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_TRUE(decomp::mesh::check_topology(*mesh).manifold());
    EXPECT_NEAR(decomp::mesh::volume_mm3(*mesh), 1.0 / 6, 1e-12);
}

TEST(ReadOff, CountsBeyondTheFileCostNoMemory) {
    expect_error(parse("OFF\n4000000000 4000000000 0\n0 0 0\n", "a.off"), "io.truncated",
                 "a.off:4");
}

TEST(ReadPly, BinaryLittleEndianDoublesComeBackBitForBit) {
    TriMesh box = tests::box({0.1, 0.2, 0.3}, {1.0 / 3, 2.0 / 3, 4});
    const auto mesh = parse(decomp::io::ply_bytes(box), "a.ply");
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_EQ(mesh->triangles, box.triangles);
    for (std::size_t i = 0; i < box.points.size(); ++i) {
        EXPECT_EQ(mesh->points[i], box.points[i]);
    }
}

TEST(ReadPly, AsciiWithExtraPropertiesAndElementsIsRead) {
    const auto mesh = parse(
        "ply\nformat ascii 1.0\ncomment hand made\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nproperty uchar red\nelement face 4\n"
        "property list uchar int vertex_index\nelement edge 1\nproperty int a\nend_header\n"
        "0 0 0 255\n1 0 0 255\n0 1 0 255\n0 0 1 255\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n7\n",
        "a.ply");
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_NEAR(decomp::mesh::volume_mm3(*mesh), 1.0 / 6, 1e-12);
}

TEST(ReadPly, BigEndianIsTheSameMesh) {
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const auto append = [&](std::uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) {
            bytes += static_cast<char>(value >> shift & 0xFFU);
        }
    };
    for (const float value : {0.F, 0.F, 0.F, 2.F, 0.F, 0.F, 0.F, 2.F, 0.F}) {
        append(std::bit_cast<std::uint32_t>(value));
    }
    bytes += '\3';
    for (const std::uint32_t corner : {0U, 1U, 2U}) {
        append(corner);
    }
    const auto mesh = parse(bytes, "a.ply");
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_NEAR(decomp::mesh::area_mm2(*mesh), 2, 1e-12);
}

TEST(ReadPly, AListLongerThanTheFileIsRefused) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float "
        "y\n"
        "property float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n";
    bytes += "\xff\xff\xff\xff";
    const auto mesh = parse(bytes, "a.ply");
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, "io.syntax");
}

TEST(ReadMedit, TheBoundaryOfTwoTetrahedraIsOutward) {
    const std::string text =
        "MeshVersionFormatted 1\nDimension 3\nVertices 5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
        "0 0 -1 0\nTetrahedra 2\n1 2 3 4 0\n1 3 2 5 0\nEnd\n";
    const auto mesh = parse(text, "a.mesh");
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_EQ(mesh->triangles.size(), 6U);
    EXPECT_TRUE(decomp::mesh::check_topology(*mesh).manifold());
    EXPECT_NEAR(decomp::mesh::volume_mm3(*mesh), 1.0 / 3, 1e-12);
}

TEST(ReadMedit, TetrahedraOfMixedSenseAreOrientedOneByOne) {
    const std::string text =
        "MeshVersionFormatted 1\nDimension\n3\nVertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
        "0 0 -1 0\nTetrahedra\n2\n1 2 3 4 0\n1 2 3 5 0\nEnd\n";
    const auto mesh = parse(text, "a.mesh");
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_TRUE(decomp::mesh::check_topology(*mesh).manifold());
    EXPECT_NEAR(decomp::mesh::volume_mm3(*mesh), 1.0 / 3, 1e-12);
}

TEST(ReadMedit, TheBoundaryOfTwoHexahedraHasTwentyTriangles) {
    std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices 12\n";
    for (int z = 0; z < 3; ++z) {
        text += "0 0 " + std::to_string(z) + " 0\n1 0 " + std::to_string(z) + " 0\n1 1 " +
                std::to_string(z) + " 0\n0 1 " + std::to_string(z) + " 0\n";
    }
    text += "Hexahedra 2\n1 2 3 4 5 6 7 8 0\n5 6 7 8 9 10 11 12 0\nEnd\n";
    const auto mesh = parse(text, "a.mesh");
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_EQ(mesh->triangles.size(), 20U);
    EXPECT_TRUE(decomp::mesh::check_topology(*mesh).manifold());
    EXPECT_NEAR(decomp::mesh::volume_mm3(*mesh), 2, 1e-12);
}

TEST(ReadMedit, AnElementThatNamesVertexZeroIsNamedByItsLine) {
    expect_error(
        parse("MeshVersionFormatted 1\nDimension 3\nVertices 1\n0 0 0 0\nTriangles 1\n0 1 1 0\n",
              "a.mesh"),
        "io.index_out_of_range", "a.mesh:6");
}

TEST(ReadMesh, TheUnitAndTheScaleMultiply) {
    const auto mesh = parse_mesh(kBoxObj, "a.obj", {.scale = 2, .unit = "in"}, decomp::Run{});
    ASSERT_TRUE(mesh);
    EXPECT_NEAR(decomp::mesh::bounds(*mesh).sizes().x(), 2 * 2 * 25.4, 1e-12);
}

TEST(ReadMesh, AnUnknownUnitIsAnError) {
    const auto mesh = parse_mesh(kBoxObj, "a.obj", {.scale = 1, .unit = "furlong"}, decomp::Run{});
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, "io.unit");
}

TEST(ReadMesh, AnEmptyFileAndAFileWithoutTrianglesAreEmpty) {
    expect_error(parse("", "a.stl"), "io.empty", "a.stl");
    expect_error(parse("solid Empty\nendsolid Empty", "a.stl"), "io.empty", "a.stl");
    expect_error(parse("# nothing\n", "a.obj"), "io.empty", "a.obj");
}

TEST(ReadMesh, BytesOfNoKnownFormatAreRefused) {
    expect_error(parse("\x89PNG\r\n\x1a\n\0\0\0\0", "a.png"), "io.unknown_format", "a.png");
}

TEST(ReadMesh, AMissingFileIsNotFound) {
    const auto mesh = decomp::io::read_mesh("/nowhere/a.stl", {}, decomp::Run{});
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, "file.not_found");
}

}  // namespace
