// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/part_ply.h"

#include "decomp/base/file.h"
#include "decomp/io/write_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

namespace {

decomp::part::Part some_part() {
    decomp::part::Part part;
    part.id = "P07";
    part.mesh = tests::box({1.0 / 3, 0, 0}, {1, 2.0 / 7, 3});
    part.sources.resize(part.mesh.triangles.size());
    part.sources[2] = {4, 1};
    part.sources[3] = {0, 12};
    return part;
}

TEST(PartPly, APartComesBackBitForBit) {
    const tests::TempDir folder;
    const auto part = some_part();
    const std::string bytes = decomp::io::part_ply_bytes(part);
    ASSERT_TRUE(decomp::write_file(folder / "P07.ply", bytes));
    const auto read = decomp::io::read_part_ply(folder / "P07.ply");
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->id, "P07");
    EXPECT_EQ(read->mesh.points, part.mesh.points);
    EXPECT_EQ(read->mesh.triangles, part.mesh.triangles);
    EXPECT_EQ(read->sources[2].plane, 4);
    EXPECT_EQ(read->sources[3].neighbour, 12);
    EXPECT_EQ(read->sources[0].plane, -1);
    EXPECT_EQ(decomp::io::part_ply_bytes(*read), bytes);
}

TEST(PartPly, APlainPlyIsAPartOfInputSurfaceOnly) {
    const auto read = decomp::io::parse_part_ply(
        decomp::io::ply_bytes(tests::box({0, 0, 0}, {1, 1, 1})), "a.ply");
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->sources.size(), 12U);
    EXPECT_FALSE(read->sources[5].is_cut());
}

TEST(PartPly, ACutOffFileIsTruncated) {
    std::string bytes = decomp::io::part_ply_bytes(some_part());
    bytes.resize(bytes.size() - 5);
    const auto read = decomp::io::parse_part_ply(bytes, "a.ply");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, "io.truncated");
}

}  // namespace
