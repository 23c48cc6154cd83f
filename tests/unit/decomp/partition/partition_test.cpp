// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/partition/partition.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/pairs.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <numbers>

namespace {

using decomp::partition::BoxPart;
using decomp::partition::partition;
using decomp::partition::Partition;
using decomp::partition::PartitionOptions;
using tests::Voxel;
using tests::voxel_pair;
using tests::VoxelPair;

const std::vector<Voxel> kEll{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

std::vector<std::int32_t> regions_of(const Partition& found) {
    std::vector<std::int32_t> out;
    for (const BoxPart& part : found.parts) {
        out.push_back(part.region);
    }
    return out;
}

/// Partitions and asserts what must hold for every result.
Partition sound(const decomp::mesh::TriMesh& volume, const VoxelPair& map,
                const PartitionOptions& options = {}) {
    decomp::Run run;
    auto found = partition(volume, map.pair, map.lattice, options, run);
    EXPECT_TRUE(found.has_value()) << (found ? "" : found.error().text());
    EXPECT_TRUE(found->complex.volumes_sum_exactly());
    const auto assembly = found->complex.assemble(regions_of(*found), run);
    EXPECT_TRUE(assembly.has_value()) << (assembly ? "" : assembly.error().text());
    double sum = 0;
    for (const auto& part : assembly->parts) {
        EXPECT_TRUE(decomp::mesh::check_topology(part.mesh).manifold());
        EXPECT_EQ(decomp::mesh::check_topology(part.mesh).components, 1U);
        sum += decomp::mesh::volume_mm3(part.mesh);
    }
    EXPECT_NEAR(sum, decomp::mesh::volume_mm3(volume), 1e-9 * sum);
    return std::move(*found);
}

TEST(Partition, EveryVoxelOfAnLBecomesAPart) {
    const VoxelPair map = voxel_pair(kEll, 10, 3);
    const Partition found = sound(map.surface, map);
    ASSERT_EQ(found.parts.size(), 3U);
    EXPECT_EQ(found.figures.cuts, 2);
    EXPECT_EQ(found.figures.healed, 0);
    EXPECT_NEAR(found.figures.mislabeled_share, 0, 1e-9);
    for (const BoxPart& part : found.parts) {
        EXPECT_NEAR(found.complex.volume_mm3(part.region), 1000, 5);
        EXPECT_NEAR(part.votes_share, 1, 1e-9);
    }
}

TEST(Partition, AShapeThatIsOneBoxIsLeftWhole) {
    const VoxelPair map = voxel_pair({{0, 0, 0}, {1, 0, 0}}, 10, 2);
    const Partition found = sound(map.surface, map);
    EXPECT_EQ(found.parts.size(), 1U);
    EXPECT_EQ(found.figures.cuts, 0);
}

TEST(Partition, ABentTShapeIsCutAcrossItsStem) {
    const VoxelPair map =
        voxel_pair({{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {1, 0, 0}}, 10, 3,
                   [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
                       return {p.x() + 0.01 * p.z() * p.z(), p.y() + 0.1 * p.x(), p.z()};
                   });
    const Partition found = sound(map.surface, map);
    EXPECT_EQ(found.parts.size(), found.sheets.boxes.size());
    EXPECT_LT(found.figures.mislabeled_share, 0.03);
}

TEST(Partition, ARingIsCutAllAround) {
    const VoxelPair map = voxel_pair(
        {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}},
        10, 2);
    const Partition found = sound(map.surface, map);
    EXPECT_EQ(found.parts.size(), 8U);
    for (const BoxPart& part : found.parts) {
        EXPECT_NEAR(found.complex.volume_mm3(part.region), 1000, 5);
    }
}

/// A beam with a slim tower at one end and a tower on a block at the other: the plane below the
/// second tower runs through the first one.
VoxelPair towers() {
    return voxel_pair({{0, 0, 0},
                       {1, 0, 0},
                       {2, 0, 0},
                       {3, 0, 0},
                       {4, 0, 0},
                       {3, 0, 1},
                       {4, 0, 1},
                       {0, 0, 1},
                       {0, 0, 2},
                       {0, 0, 3},
                       {4, 0, 2},
                       {4, 0, 3}},
                      10, 2);
}

TEST(Partition, ACutThatOnlyOneTowerNeedsLeavesTheOtherWhole) {
    const VoxelPair map = towers();
    PartitionOptions whole;
    whole.limit_cuts = false;
    const Partition limited = sound(map.surface, map);
    const Partition full = sound(map.surface, map, whole);
    EXPECT_EQ(limited.parts.size(), limited.sheets.boxes.size());
    EXPECT_EQ(full.parts.size(), full.sheets.boxes.size());
    EXPECT_GE(limited.figures.limited_cuts, 1);
    EXPECT_EQ(full.figures.limited_cuts, 0);
    EXPECT_LE(limited.figures.healed, full.figures.healed);
    EXPECT_LE(limited.figures.mislabeled_share, full.figures.mislabeled_share + 1e-9);
}

TEST(Partition, TheVolumeNeedNotBeTheSurfaceOfTheMap) {
    // The map knows a coarse L; what is cut is a finer one with rounded ends beside it.
    const VoxelPair map = voxel_pair(kEll, 10, 2);
    const VoxelPair finer = voxel_pair(kEll, 10, 6, [](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(
            p + 0.2 * Eigen::Vector3d(std::sin(p.y()), std::sin(p.z()), std::sin(p.x())));
    });
    const Partition found = sound(finer.surface, map);
    EXPECT_EQ(found.parts.size(), 3U);
    EXPECT_LT(found.figures.lost_share, 0.05);
}

TEST(Partition, AMapThatKnowsNothingOfABodyLeavesItAPartOfItsOwn) {
    const VoxelPair map = voxel_pair(kEll, 10, 2);
    const auto both = tests::joined(map.surface, tests::box({50, 0, 0}, {60, 10, 10}));
    const Partition found = sound(both, map);
    EXPECT_EQ(found.parts.size(), 4U);
    EXPECT_EQ(found.parts.front().box, -1);
}

TEST(Partition, AnAbsurdMapStillGivesAnExactPartition) {
    VoxelPair map = voxel_pair(kEll, 10, 3);
    for (std::size_t i = 0; i < map.pair.polycube.size(); ++i) {
        map.pair.polycube[i] +=
            6 * Eigen::Vector3d(std::sin(9.0 * double(i)), std::sin(5.0 * double(i)), 0);
    }
    const Partition found = sound(map.surface, map);
    EXPECT_GE(found.parts.size(), 1U);
    EXPECT_GT(found.cells.flipped, 0);
}

TEST(Partition, TheSameInputGivesTheSameParts) {
    const VoxelPair map = towers();
    const Partition one = sound(map.surface, map);
    const Partition two = sound(map.surface, map);
    ASSERT_EQ(regions_of(one), regions_of(two));
    for (const BoxPart& part : one.parts) {
        EXPECT_EQ(one.complex.region(part.region).mesh.points,
                  two.complex.region(part.region).mesh.points);
    }
}

TEST(Partition, ACancelledRunIsAnError) {
    const VoxelPair map = voxel_pair(kEll, 10, 2);
    decomp::Run run;
    std::stop_source source;
    source.request_stop();
    run.stop = source.get_token();
    const auto found = partition(map.surface, map.pair, map.lattice, {}, run);
    ASSERT_FALSE(found.has_value());
    EXPECT_EQ(found.error().code, "run.cancelled");
}

}  // namespace
