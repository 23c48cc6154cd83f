// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/mill4.h"
#include "decomp/io/read_mesh.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/part_shapes.h"
#include "tests/support/subdivide.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace {

using cam::check::check_mill4;
using cam::check::Mill4Options;
using decomp::mesh::TriMesh;

Mill4Options searched(const TriMesh& mesh) {
    Mill4Options options;
    options.find_indices = false;
    options.axis = check_mill4(tests::whole(mesh), options, {}, {}).value().axes.front().axis;
    return options;
}

/// The paper's test (7.3): the same surface from more samples, about the same axis.
void expect_same_percentages(const TriMesh& mesh) {
    const Mill4Options options = searched(mesh);
    const auto once = check_mill4(tests::whole(mesh), options, {}, {}).value();
    const TriMesh twice = tests::doubled(mesh);
    const TriMesh four_times = tests::midpoint_subdivided(mesh);
    EXPECT_GT(twice.triangles.size(), 1.6 * mesh.triangles.size());
    EXPECT_EQ(four_times.triangles.size(), 4 * mesh.triangles.size());
    for (const TriMesh* finer : {&twice, &four_times}) {
        ASSERT_TRUE(decomp::mesh::check_topology(*finer).manifold());
        ASSERT_NEAR(decomp::mesh::area_mm2(*finer) / decomp::mesh::area_mm2(mesh), 1, 1e-12);
        const auto more = check_mill4(tests::whole(*finer), options, {}, {}).value();
        EXPECT_NEAR(more.unseen.by_facets_percent, once.unseen.by_facets_percent, 0.1);
        EXPECT_NEAR(more.unseen.by_area_percent, once.unseen.by_area_percent, 0.1);
        EXPECT_NEAR(more.ends.by_area_percent, once.ends.by_area_percent, 1e-6);
    }
}

class Oversampled : public testing::TestWithParam<const char*> {};

TEST_P(Oversampled, ModelsKeepTheirPercentage) {
    const char* models = std::getenv("HEW_MODELS");
    if (models == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    const auto mesh = decomp::io::read_mesh(std::filesystem::path(models) / GetParam(), {}, {});
    ASSERT_TRUE(mesh.has_value()) << mesh.error().text();
    expect_same_percentages(*mesh);
}

INSTANTIATE_TEST_SUITE_P(Models, Oversampled,
                         testing::Values("paper/hfd_maxplank.obj", "paper/hfd_BU.obj",
                                         "paper/av_moai.mesh"));

TEST(Oversampling, AFineTorusKeepsItsPercentage) {
    Mill4Options options;
    options.axis = Eigen::Vector3d(0.1, 0.05, 1);
    options.find_indices = false;
    const TriMesh torus = tests::torus(20, 8, 160, 80);
    const auto once = check_mill4(tests::whole(torus), options, {}, {}).value();
    const auto more =
        check_mill4(tests::whole(tests::midpoint_subdivided(torus)), options, {}, {}).value();
    EXPECT_GT(once.unseen.by_area_percent, 5);
    EXPECT_NEAR(more.unseen.by_area_percent, once.unseen.by_area_percent, 0.1);
    EXPECT_NEAR(more.unseen.by_facets_percent, once.unseen.by_facets_percent, 0.1);
}

TEST(Oversampling, ADumbbellKeepsItsPercentage) {
    expect_same_percentages(tests::dumbbell(20, 6, 50, 7, 128));
}

}  // namespace
