// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/polycube/generate.h"

#include "decomp/cells/cells.h"
#include "decomp/mesh/measure.h"
#include "decomp/polycube/candidate_detail.h"
#include "decomp/polycube/check.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace {

using namespace decomp;

polycube::Polycube made(const mesh::TriMesh& volume, polycube::GenerateOptions options = {}) {
    decomp::Run run;
    options.proxy_triangles = 1200;
    auto result = polycube::generate(volume, options, {}, run);
    EXPECT_TRUE(result.has_value()) << result.error().text();
    return *result;
}

TEST(Generate, ASphereIsOneBlockWithoutFlips) {
    const auto cube = made(tests::sphere(10, 48, 31));
    const auto report = polycube::check_pair(cube.pair, cube.labels);
    EXPECT_EQ(report.tier, "T1");
    EXPECT_EQ(cube.figures.cells, 1);
    EXPECT_EQ(report.charts, 6);
    EXPECT_EQ(cube.figures.flips, report.flips);
}

TEST(Generate, ATorusIsAFrameOfEightBlocks) {
    const auto cube = made(tests::torus(12, 5, 64, 32));
    const auto report = polycube::check_pair(cube.pair, cube.labels);
    EXPECT_TRUE(report.labels_valid());
    EXPECT_EQ(cube.figures.cells, 8);
    EXPECT_LT(report.flipped_share, 1e-3);
}

TEST(Generate, ATurnedBoxIsTurnedBack) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.2, 0.3, 1).normalized()).toRotationMatrix();
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.linear() = turn;
    const auto volume = mesh::transformed(tests::box({0, 0, 0}, {30, 20, 10}), map);
    const auto cube = made(volume);
    EXPECT_EQ(polycube::check_pair(cube.pair, cube.labels).labels_valid(), true);
    EXPECT_GT(cube.figures.fidelity, 0.99);
    // The shape stays in the model frame; its outline in the polycube's is the box.
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : cube.pair.polycube) {
        box.extend(p);
    }
    EXPECT_NEAR(box.volume(), 6000, 60);
    polycube::GenerateOptions keep;
    keep.rotation = Eigen::Matrix3d::Identity();
    EXPECT_TRUE(made(volume, keep).rotation.isIdentity(0));
}

TEST(Generate, TheSameAtAnyNumberOfThreads) {
    const auto volume = tests::dumbbell(10, 4, 30, 5, 32);
    polycube::GenerateOptions options;
    options.proxy_triangles = 600;
    options.compactness = 2;
    std::vector<polycube::Polycube> results;
    for (const int jobs : {1, 3}) {
        decomp::Run run;
        run.jobs = jobs;
        auto result = polycube::generate(volume, options, {}, run);
        ASSERT_TRUE(result.has_value()) << result.error().text();
        results.push_back(std::move(*result));
    }
    EXPECT_EQ(results[0].figures.start, results[1].figures.start);
    EXPECT_TRUE(results[0].pair.polycube == results[1].pair.polycube);
    EXPECT_TRUE(results[0].pair.tets == results[1].pair.tets);
}

TEST(Generate, TheVoteErrorTakesPart) {
    int calls = 0;
    decomp::Run run;
    polycube::GenerateOptions options;
    options.proxy_triangles = 1000;
    const auto cube = polycube::generate(
        tests::sphere(10, 48, 31), options,
        [&](const tets::Pair&, const tets::Lattice&, const mesh::TriMesh&) {
            ++calls;
            return 0.25;
        },
        run);
    ASSERT_TRUE(cube.has_value());
    EXPECT_EQ(calls, cube->figures.tried);
    EXPECT_EQ(cube->figures.vote_error, 0.25);
}

TEST(Generate, RefusesOptionsOutsideTheirRange) {
    decomp::Run run;
    const auto volume = tests::box({0, 0, 0}, {1, 1, 1});
    polycube::GenerateOptions compactness;
    compactness.compactness = 0;
    polycube::GenerateOptions starts;
    starts.starts = 0;
    polycube::GenerateOptions target;
    target.target_parts = -1;
    for (const auto& options : {compactness, starts, target}) {
        EXPECT_EQ(polycube::generate(volume, options, {}, run).error().code, "polycube.options");
    }
    EXPECT_EQ(polycube::generate({}, {}, {}, run).error().code, "polycube.options");
}

TEST(IdentityPolycube, StandsForAnyVolumeAndItsPlanesCutAtEvents) {
    // Two balls and a waist: the neck is an event.
    const auto cube =
        polycube::identity_polycube(tests::dumbbell(10, 4, 30, 5, 32), Eigen::Matrix3d::Identity());
    EXPECT_EQ(polycube::check_pair(cube.pair, {}).tier, "T4");
    EXPECT_EQ(cube.tier, "T4");
    const auto& along = cube.lattice.planes[2];
    ASSERT_GE(along.size(), 3U);
    EXPECT_TRUE(std::any_of(along.begin(), along.end(),
                            [](double plane) { return std::abs(plane - 5) < 3; }));
    const auto cells = cells::cells_of(cube.pair, cube.lattice, {});
    ASSERT_TRUE(cells.has_value()) << cells.error().text();
    EXPECT_GE(cells->cells.size(), 2U);
}

TEST(IdentityPolycube, EvenOfAPlateThinnerThanItsVoxels) {
    const auto cube = polycube::identity_polycube(tests::box({0, 0, 0}, {100, 80, 0.01}),
                                                  Eigen::Matrix3d::Identity());
    EXPECT_FALSE(cube.pair.tets.empty());
    for (const auto& planes : cube.lattice.planes) {
        EXPECT_GE(planes.size(), 2U);
    }
    EXPECT_TRUE(cells::cells_of(cube.pair, cube.lattice, {}).has_value());
}

}  // namespace
