// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/oracle/decomp/partition/checker.h"

#include "tests/oracle/decomp/partition/sample.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using tests::Fault;
using tests::faults_of;
using tests::Sample;

/// An L with wavy sides in three parts.
Sample sample() {
    const auto map =
        tests::voxel_pair({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 10, 4, [](const Eigen::Vector3d& p) {
            return Eigen::Vector3d(
                p + 0.3 * Eigen::Vector3d(std::sin(p.y()), std::sin(p.z()), std::sin(p.x())));
        });
    return tests::partitioned(map.surface, map.pair, map.lattice);
}

/// A cut triangle of a part.
std::size_t cap_of(const decomp::part::Part& part) {
    for (std::size_t t = 0; t < part.sources.size(); ++t) {
        if (part.sources[t].is_cut()) {
            return t;
        }
    }
    return 0;
}

TEST(PartitionChecker, FindsNothingWrongWithASoundPartition) {
    const Sample s = sample();
    ASSERT_EQ(s.assembly.parts.size(), 3U);
    EXPECT_TRUE(faults_of(s.assembly, s.shape).empty());
}

TEST(PartitionChecker, SeesAMissingTriangle) {
    Sample s = sample();
    auto& part = s.assembly.parts[1];
    part.mesh.triangles.pop_back();
    part.sources.pop_back();
    EXPECT_TRUE(faults_of(s.assembly, s.shape).contains(Fault::Open));
}

TEST(PartitionChecker, SeesATurnedTriangle) {
    Sample s = sample();
    std::swap(s.assembly.parts[0].mesh.triangles[0][0], s.assembly.parts[0].mesh.triangles[0][1]);
    EXPECT_TRUE(faults_of(s.assembly, s.shape).contains(Fault::Misoriented));
}

TEST(PartitionChecker, SeesAPartTurnedInsideOut) {
    Sample s = sample();
    for (auto& t : s.assembly.parts[2].mesh.triangles) {
        std::swap(t[0], t[1]);
    }
    EXPECT_TRUE(faults_of(s.assembly, s.shape).contains(Fault::Misoriented));
}

TEST(PartitionChecker, SeesTwoBodiesInOnePart) {
    Sample s = sample();
    auto& into = s.assembly.parts[1];
    const auto& from = s.assembly.parts[2];
    const auto shift = static_cast<std::uint32_t>(into.mesh.points.size());
    into.mesh.points.insert(into.mesh.points.end(), from.mesh.points.begin(),
                            from.mesh.points.end());
    for (const auto& t : from.mesh.triangles) {
        into.mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    }
    into.sources.insert(into.sources.end(), from.sources.begin(), from.sources.end());
    EXPECT_TRUE(faults_of(s.assembly, s.shape).contains(Fault::Components));
}

TEST(PartitionChecker, SeesACornerPulledThroughTheOtherSide) {
    Sample s = sample();
    auto& points = s.assembly.parts[0].mesh.points;
    points.front() += Eigen::Vector3d(33, 29, 31);
    EXPECT_TRUE(faults_of(s.assembly, s.shape).contains(Fault::Crossing));
}

TEST(PartitionChecker, SeesACapThatDiffersInItsLastBit) {
    Sample s = sample();
    auto& part = s.assembly.parts[1];
    double& x = part.mesh.points[part.mesh.triangles[cap_of(part)][0]].x();
    x = std::nextafter(x, 1e9);
    const auto faults = faults_of(s.assembly, s.shape);
    EXPECT_EQ(faults, std::set<Fault>{Fault::Twin});
}

TEST(PartitionChecker, SeesAMissingPart) {
    Sample s = sample();
    s.assembly.parts.pop_back();
    const auto faults = faults_of(s.assembly, s.shape);
    EXPECT_TRUE(faults.contains(Fault::Gap));
    EXPECT_TRUE(faults.contains(Fault::Volume));
}

TEST(PartitionChecker, SeesAPartThatStandsTwice) {
    Sample s = sample();
    s.assembly.parts.push_back(s.assembly.parts[1]);
    EXPECT_TRUE(faults_of(s.assembly, s.shape).contains(Fault::Overlap));
}

TEST(PartitionChecker, SeesAPartThatHasMovedALittle) {
    Sample s = sample();
    for (auto& point : s.assembly.parts[2].mesh.points) {
        point += Eigen::Vector3d(0.05, 0.05, 0.05);
    }
    const auto faults = faults_of(s.assembly, s.shape);
    EXPECT_TRUE(faults.contains(Fault::Gap) || faults.contains(Fault::Overlap));
    EXPECT_TRUE(faults.contains(Fault::Twin));
    EXPECT_TRUE(faults.contains(Fault::NotPlanar));
}

TEST(PartitionChecker, SeesABumpInACut) {
    Sample s = sample();
    // The same bump in both neighbours: a good fit, but not planar.
    const auto& cap =
        s.assembly.parts[1]
            .mesh.points[s.assembly.parts[1].mesh.triangles[cap_of(s.assembly.parts[1])][0]];
    const Eigen::Vector3d old = cap;
    for (auto& part : s.assembly.parts) {
        for (auto& point : part.mesh.points) {
            if (point == old) {
                point += Eigen::Vector3d(1e-4, 1e-4, 1e-4);
            }
        }
    }
    EXPECT_TRUE(faults_of(s.assembly, s.shape).contains(Fault::NotPlanar));
}

}  // namespace
