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

}  // namespace
