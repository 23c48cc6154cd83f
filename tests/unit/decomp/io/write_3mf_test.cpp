// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/write_3mf.h"

#include "decomp/io/read_mesh.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

std::vector<decomp::io::ThreemfObject> two_boxes() {
    decomp::io::ThreemfObject a{"P01", tests::box({0, 0, 0}, {1, 2, 3})};
    decomp::io::ThreemfObject b{"P02", tests::box({0, 0, 0}, {1, 1, 1})};
    b.placed_from_mesh.linear() =
        Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitZ()).matrix();
    b.placed_from_mesh.translation() = Eigen::Vector3d(10, 20, 30);
    return {a, b};
}

TEST(Write3mf, ObjectsComeBackWhereTheyWerePlaced) {
    const auto bytes = decomp::io::threemf_bytes(two_boxes());
    ASSERT_TRUE(bytes) << bytes.error().text();
    const auto mesh = decomp::io::parse_mesh(*bytes, "a.3mf", {}, decomp::Run{});
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_EQ(mesh->triangles.size(), 24U);
    EXPECT_TRUE(decomp::mesh::check_topology(*mesh).manifold());
    EXPECT_NEAR(decomp::mesh::volume_mm3(*mesh), 7, 1e-5);
    const Eigen::AlignedBox3d box = decomp::mesh::bounds(*mesh);
    EXPECT_NEAR(box.max().x(), 10, 1e-5);
    EXPECT_NEAR(box.max().y(), 21, 1e-5);
    EXPECT_NEAR(box.max().z(), 31, 1e-5);
}

TEST(Write3mf, EqualObjectsGiveEqualBytesWithoutATime) {
    const auto first = decomp::io::threemf_bytes(two_boxes());
    const auto second = decomp::io::threemf_bytes(two_boxes());
    ASSERT_TRUE(first && second);
    EXPECT_EQ(*first, *second);
    for (std::size_t at = first->find("PK\x03\x04"); at != std::string::npos;
         at = first->find("PK\x03\x04", at + 1)) {
        EXPECT_EQ(first->substr(at + 10, 4), std::string(4, '\0'));
    }
}

TEST(Read3mf, ABrokenPackageIsAnError) {
    auto bytes = decomp::io::threemf_bytes(two_boxes());
    ASSERT_TRUE(bytes);
    for (const std::size_t size : {std::size_t{30}, bytes->size() / 2, bytes->size() - 3}) {
        const auto mesh =
            decomp::io::parse_mesh(bytes->substr(0, size), "a.3mf", {}, decomp::Run{});
        ASSERT_FALSE(mesh);
        EXPECT_EQ(mesh.error().code, "io.threemf");
    }
}

}  // namespace
