// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/write_mesh.h"

#include "decomp/io/read_mesh.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

TEST(WriteMesh, ObjDecimalsReadBackAsTheSameDoubles) {
    const auto sphere = tests::sphere(10.0 / 3, 12, 5);
    const auto read =
        decomp::io::parse_mesh(decomp::io::obj_bytes(sphere), "a.obj", {}, decomp::Run{});
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->points, sphere.points);
    EXPECT_EQ(read->triangles, sphere.triangles);
}

TEST(WriteMesh, AnStlHasItsExactLengthAndDoesNotBeginWithSolid) {
    const std::string bytes = decomp::io::stl_bytes(tests::box({0, 0, 0}, {1, 1, 1}));
    EXPECT_EQ(bytes.size(), 84U + 50U * 12U);
    EXPECT_FALSE(bytes.starts_with("solid"));
}

TEST(WriteMesh, AnStlReadBackWritesTheSameBytes) {
    const std::string bytes = decomp::io::stl_bytes(tests::torus(10, 3, 24, 12));
    const auto read = decomp::io::parse_mesh(bytes, "a.stl", {}, decomp::Run{});
    ASSERT_TRUE(read);
    EXPECT_EQ(decomp::io::stl_bytes(*read), bytes);
}

TEST(WriteMesh, AColouredPlyReadsBackAsTheSameMeshAndHoldsItsColours) {
    const auto sphere = tests::sphere(10.0 / 3, 12, 5);
    std::vector<std::array<std::uint8_t, 3>> colours(sphere.triangles.size(), {10, 20, 30});
    colours.back() = {201, 202, 203};
    const std::string bytes = decomp::io::ply_bytes(sphere, colours);
    const auto read = decomp::io::parse_mesh(bytes, "a.ply", {}, decomp::Run{});
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->points, sphere.points);
    EXPECT_EQ(read->triangles, sphere.triangles);
    EXPECT_NE(bytes.find("property uchar red"), std::string::npos);
    EXPECT_EQ(bytes.substr(bytes.size() - 3), "\xC9\xCA\xCB");
}

}  // namespace
