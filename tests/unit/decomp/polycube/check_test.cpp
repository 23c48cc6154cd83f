// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/polycube/check.h"

#include "decomp/polycube/exact_detail.h"
#include "tests/support/tet_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace decomp;

/// A block or another voxel shape whose polycube is itself, stretched by 2 along x.
tets::Pair stretched(const std::function<bool(int, int, int)>& filled) {
    const auto mesh = tests::voxel_tets({3, 3, 2}, filled);
    tets::Pair pair{mesh.points, mesh.points, mesh.tets};
    for (Eigen::Vector3d& p : pair.polycube) {
        p.x() *= 2;
    }
    return pair;
}

bool all(int, int, int) { return true; }

bool ring(int i, int j, int) { return i != 1 || j != 1; }

TEST(CheckPair, ABlockIsT1WithSixChartsAndEightCorners) {
    const auto report = polycube::check_pair(stretched(all), {});
    EXPECT_EQ(report.tier, "T1");
    EXPECT_EQ(report.charts, 6);
    EXPECT_EQ(report.corners, 8);
    EXPECT_EQ(report.flips, 0U);
    EXPECT_FALSE(report.overlaps);
}

TEST(CheckPair, ARingHasTenChartsAndSixteenCorners) {
    const auto report = polycube::check_pair(stretched(ring), {});
    EXPECT_EQ(report.tier, "T1");
    EXPECT_EQ(report.charts, 10);
    EXPECT_EQ(report.corners, 16);
}

TEST(CheckPair, AMirroredPairIsAsGood) {
    auto pair = stretched(ring);
    for (Eigen::Vector3d& p : pair.polycube) {
        p.y() = -p.y();
    }
    const auto report = polycube::check_pair(pair, {});
    EXPECT_EQ(report.tier, "T1");
    EXPECT_EQ(report.flips, 0U);
}

TEST(CheckPair, TheShapeItselfIsT4) {
    auto pair = stretched(all);
    pair.polycube = pair.shape;
    EXPECT_EQ(polycube::check_pair(pair, {}).tier, "T4");
    for (Eigen::Vector3d& p : pair.polycube) {
        p = Eigen::Vector3d(-p.y() + 5, p.x(), p.z());
    }
    EXPECT_EQ(polycube::check_pair(pair, {}).tier, "T4");
}

TEST(CheckPair, AnInvertedTetIsT2) {
    auto pair = stretched(all);
    // The innermost point leaves through the side.
    for (std::size_t i = 0; i < pair.shape.size(); ++i) {
        if (pair.shape[i] == Eigen::Vector3d(1, 1, 1)) {
            pair.polycube[i].x() += 20;
        }
    }
    const auto report = polycube::check_pair(pair, {});
    EXPECT_GT(report.flips, 0U);
    EXPECT_GT(report.flipped_share, 0);
    EXPECT_EQ(report.tier, "T2");
}

TEST(CheckPair, AFacetOffItsPlaneByOneBitIsT3) {
    auto pair = stretched(all);
    for (std::size_t i = 0; i < pair.shape.size(); ++i) {
        if (pair.shape[i] == Eigen::Vector3d(1, 1, 2)) {
            pair.polycube[i].z() = std::nextafter(pair.polycube[i].z(), 3);
        }
    }
    const auto report = polycube::check_pair(pair, {});
    EXPECT_GT(report.off_axis_facets, 0U);
    EXPECT_EQ(report.tier, "T3");
}

TEST(CheckPair, LabelsThatLieAreSeen) {
    const auto pair = stretched(all);
    const auto report = polycube::check_pair(pair, {});
    labels::Labeling labels(report.facets, labels::AxisLabel::PlusX);
    EXPECT_EQ(polycube::check_pair(pair, labels).tier, "T3");
    labels.pop_back();
    EXPECT_EQ(polycube::check_pair(pair, labels).tier, "T3");
}

TEST(CheckPair, ChartsWithTooFewNeighboursAreSeen) {
    // A block whose top is labelled as a side: opposite labels touch, charts are poor.
    auto pair = stretched([](int i, int j, int k) { return k == 0 || (i == 1 && j == 1); });
    const auto good = polycube::check_pair(pair, {});
    EXPECT_EQ(good.tier, "T1");
    EXPECT_EQ(good.charts, 11);
    for (Eigen::Vector3d& p : pair.polycube) {
        p.z() = 0;
    }
    const auto flat = polycube::check_pair(pair, {});
    EXPECT_EQ(flat.flips, pair.tets.size());
    EXPECT_NE(flat.tier, "T1");
}

TEST(CheckPair, APolycubeThatRunsIntoItselfIsTold) {
    // Two blocks joined by a bar, bent in the polycube so that one lies in the other.
    auto pair = stretched(ring);
    const auto before = polycube::check_pair(pair, {});
    EXPECT_FALSE(before.overlaps);
    tets::Pair twice = pair;
    const auto shift = static_cast<std::uint32_t>(pair.shape.size());
    for (std::size_t i = 0; i < pair.shape.size(); ++i) {
        twice.shape.push_back(pair.shape[i] + Eigen::Vector3d(10, 0, 0));
        twice.polycube.push_back(pair.polycube[i] + Eigen::Vector3d(0.5, 0.5, 0.5));
    }
    for (tets::Tet tet : pair.tets) {
        for (std::uint32_t& corner : tet) {
            corner += shift;
        }
        twice.tets.push_back(tet);
    }
    const auto report = polycube::check_pair(twice, {});
    EXPECT_EQ(report.flips, 0U);
    EXPECT_TRUE(report.overlaps);
}

TEST(ExactSigns, ToldWhereDoublesCannot) {
    const Eigen::Vector3d a(0.1, 0.1, 0.1);
    const Eigen::Vector3d b(0.3, 0.3, 0.3);
    const Eigen::Vector3d c(0.7, 0.2, 0.5);
    const Eigen::Vector3d middle = (a + c) / 2;
    Eigen::Vector3d above = middle;
    above.z() = std::nextafter(above.z(), 1);
    Eigen::Vector3d below = middle;
    below.z() = std::nextafter(std::nextafter(below.z(), 0), 0);
    EXPECT_EQ(polycube::volume_sign(a, b, c, a), 0);
    EXPECT_EQ(polycube::volume_sign(a, b, c, above), -polycube::volume_sign(a, b, c, below));
    EXPECT_EQ(polycube::area_sign({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2), 1);
    EXPECT_EQ(polycube::area_sign({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 2), -1);
    EXPECT_EQ(polycube::area_sign({0, 0, 0}, {1, 1, 0}, {2, 2, 0}, 2), 0);
}

}  // namespace
