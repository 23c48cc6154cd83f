// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sheets/sheets.h"

#include "decomp/sheets/paper.h"
#include "tests/support/pairs.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace {

using decomp::cells::CellComplex;
using decomp::sheets::mapped_plane;
using decomp::sheets::Sheets;
using decomp::sheets::sheets_of;
using decomp::sheets::Sweep;
using tests::Bend;
using tests::Voxel;
using tests::voxel_pair;

const std::vector<Voxel> kBar{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
const std::vector<Voxel> kEll{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<Voxel> kRing{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0},
                               {2, 1, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}};

CellComplex cells(const std::vector<Voxel>& voxels, const Bend& bend = {}) {
    const auto made = bend ? voxel_pair(voxels, 10, 2, bend) : voxel_pair(voxels, 10, 2);
    auto out = decomp::cells::cells_of(made.pair, made.lattice, {});
    EXPECT_TRUE(out.has_value());
    return std::move(*out);
}

TEST(Sheets, ABarWithoutConcaveEdgesStaysOneBox) {
    const Sheets found = sheets_of(cells(kBar), {});
    EXPECT_EQ(found.boxes.size(), 1U);
    EXPECT_TRUE(found.sheets.empty());
    EXPECT_NEAR(found.boxes[0].volume_mm3, 3000, 1e-9);
    EXPECT_EQ(found.boxes[0].high, (std::array<int, 3>{3, 1, 1}));
}

TEST(Sheets, AConcaveEdgeCutsAlongBothOfItsPlanes) {
    const Sheets found = sheets_of(cells(kEll), {});
    EXPECT_EQ(found.boxes.size(), 3U);
    ASSERT_EQ(found.sheets.size(), 2U);
    for (const auto& sheet : found.sheets) {
        EXPECT_NEAR(sheet.area_mm2, 100, 1e-9);
        EXPECT_LT(sheet.residual.max_mm, 1e-9);
        const auto& plane = found.planes[static_cast<std::size_t>(sheet.plane)];
        EXPECT_NEAR(plane.plane.normal[sheet.axis], 1, 1e-12);
        EXPECT_NEAR(plane.plane.offset_mm, 10, 1e-9);
    }
}

TEST(Sheets, ARingOfEightVoxelsIsEightBoxesOnFourPlanes) {
    const Sheets found = sheets_of(cells(kRing), {});
    EXPECT_EQ(found.boxes.size(), 8U);
    EXPECT_EQ(found.sheets.size(), 8U);
    EXPECT_EQ(found.planes.size(), 4U);  // both sheets of a level lie in one plane and share it
}

TEST(Sheets, TheGlobalSweepCutsWhatTheLocalOneLeaves) {
    // A long bar with a short one beside its first voxel, apart from a third piece in the same
    // level: only the global sweep cuts the far leg where the near one has a concave edge.
    const std::vector<Voxel> comb{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0},
                                  {3, 1, 0}, {3, 2, 0}, {0, 0, 1}, {0, 1, 1}};
    const Sheets local = sheets_of(cells(comb), {});
    const Sheets global = sheets_of(cells(comb), {.sweep = Sweep::Global});
    EXPECT_LE(local.boxes.size(), global.boxes.size());
    double volume = 0;
    for (const auto& box : global.boxes) {
        volume += box.volume_mm3;
        EXPECT_NEAR(box.volume_mm3,
                    1000.0 * (box.high[0] - box.low[0]) * (box.high[1] - box.low[1]) *
                        (box.high[2] - box.low[2]),
                    1e-6);
    }
    EXPECT_NEAR(volume, 9000, 1e-6);
}

TEST(Sheets, ASheetThatLiesAslantGetsASlantedPlaneTowardsTheUpperBox) {
    const Sheets found = sheets_of(cells(kEll,
                                         [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
                                             return {p.x() + 0.4 * p.z(), p.y(), p.z()};
                                         }),
                                   {});
    const Eigen::Vector3d slanted = Eigen::Vector3d(1, 0, -0.4).normalized();
    const bool seen = std::any_of(found.planes.begin(), found.planes.end(), [&](const auto& p) {
        return p.axis == 0 && !p.snapped && p.plane.normal.isApprox(slanted, 1e-6);
    });
    EXPECT_TRUE(seen);
}

TEST(Sheets, ASheetWithinFiveDegreesOfItsAxisSnapsToIt) {
    const Sheets found = sheets_of(cells(kEll,
                                         [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
                                             return {p.x() + 0.01 * p.z(), p.y(), p.z()};
                                         }),
                                   {});
    for (const auto& plane : found.planes) {
        EXPECT_TRUE(plane.snapped);
        EXPECT_EQ(plane.plane.normal[plane.axis], 1);
    }
}

TEST(Sheets, TwoStepsOfDifferentHeightDoNotShareAPlane) {
    // Both outer columns stand on the beam; in the shape one of them starts a good deal higher.
    const std::vector<Voxel> goal{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {2, 0, 1}};
    const Sheets found = sheets_of(cells(goal,
                                         [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
                                             return {p.x(), p.y(), p.z() * (p.x() > 15 ? 1.5 : 1)};
                                         }),
                                   {});
    std::vector<double> heights;
    for (const auto& plane : found.planes) {
        if (plane.axis == 2) {
            heights.push_back(plane.plane.offset_mm);
        }
    }
    std::sort(heights.begin(), heights.end());
    ASSERT_EQ(heights.size(), 2U);
    EXPECT_NEAR(heights[0], 10, 1e-6);
    EXPECT_NEAR(heights[1], 15, 1e-6);
}

TEST(PaperSheets, CornersOfASideAreMappedBackThroughTheTets) {
    const auto made = voxel_pair(kEll, 10, 2, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
        return {p.x() + 0.3 * p.z(), p.y(), p.z()};
    });
    const auto complex = decomp::cells::cells_of(made.pair, made.lattice, {});
    ASSERT_TRUE(complex.has_value());
    const Sheets found = decomp::sheets::paper_sheets(*complex, made.lattice, {});
    ASSERT_EQ(found.boxes.size(), 3U);
    ASSERT_EQ(found.sheets.size(), 2U);
    ASSERT_EQ(found.planes.size(), 2U);
    for (const auto& sheet : found.sheets) {
        ASSERT_EQ(sheet.corners.size(), 4U);
        EXPECT_LT(sheet.residual.max_mm, 1e-9);
        if (sheet.axis == 0) {
            const auto& plane = found.planes[static_cast<std::size_t>(sheet.plane)].plane;
            EXPECT_TRUE(plane.normal.isApprox(Eigen::Vector3d(1, 0, -0.3).normalized(), 1e-9));
            for (const Eigen::Vector3d& corner : sheet.corners) {
                EXPECT_NEAR(corner.x() - 0.3 * corner.z(), 10, 1e-9);
            }
        }
    }
}

TEST(PaperSheets, ATwistedSideIsFlattenedAndItsNeighbourTurnsAboutTheCommonEdge) {
    // The common edge of both sides of the L is the pivot: its corners lie on both planes.
    const auto made = voxel_pair(kEll, 10, 3, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
        return {p.x() + 0.008 * p.y() * p.z(), p.y() + 0.004 * p.x() * p.z(), p.z()};
    });
    const auto complex = decomp::cells::cells_of(made.pair, made.lattice, {});
    ASSERT_TRUE(complex.has_value());
    const Sheets found = decomp::sheets::paper_sheets(*complex, made.lattice, {});
    ASSERT_EQ(found.sheets.size(), 2U);
    int shared = 0;
    for (const Eigen::Vector3d& a : found.sheets[0].corners) {
        for (const Eigen::Vector3d& b : found.sheets[1].corners) {
            shared += a == b ? 1 : 0;
        }
    }
    EXPECT_EQ(shared, 2);
    for (const auto& sheet : found.sheets) {
        EXPECT_LT(sheet.residual.max_mm, 1e-9);
    }
}

TEST(PaperSheets, ACrossingOfFourSidesKeepsAStatedResidual) {
    // The middle of two by two by two boxes has twelve sides; not all can be flat and meet.
    std::vector<Voxel> cross;
    for (int i = 0; i < 27; ++i) {
        const Voxel v{i / 9, i / 3 % 3, i % 3};
        if ((v[0] != 1 ? 1 : 0) + (v[1] != 1 ? 1 : 0) + (v[2] != 1 ? 1 : 0) < 3) {
            cross.push_back(v);
        }
    }
    const auto made = voxel_pair(cross, 10, 1, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
        return {p.x() + 0.4 * std::sin(p.y() / 3), p.y() + 0.4 * std::sin(p.z() / 4),
                p.z() + 0.4 * std::sin(p.x() / 5)};
    });
    const auto complex = decomp::cells::cells_of(made.pair, made.lattice, {});
    ASSERT_TRUE(complex.has_value());
    const Sheets found = decomp::sheets::paper_sheets(*complex, made.lattice, {});
    EXPECT_EQ(found.boxes.size(), cross.size());
    for (const auto& sheet : found.sheets) {
        EXPECT_GE(sheet.plane, 0);
        EXPECT_LT(sheet.residual.max_mm, 0.05 * found.diagonal_mm);
    }
}

TEST(Sheets, APlaneOfThePolycubeIsMappedIntoItsBoxes) {
    const CellComplex complex = cells(kBar, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
        return {2 * p.x() + 0.3 * p.y(), p.y(), p.z()};
    });
    const auto plane = mapped_plane(complex, std::vector<char>(complex.cells.size(), 1), 0, 13);
    ASSERT_TRUE(plane.has_value());
    EXPECT_TRUE(plane->normal.isApprox(Eigen::Vector3d(1, -0.3, 0).normalized(), 1e-6));
    EXPECT_NEAR(plane->offset_mm, 26 / std::hypot(1, 0.3), 1e-6);
    EXPECT_FALSE(
        mapped_plane(complex, std::vector<char>(complex.cells.size(), 0), 0, 13).has_value());
    EXPECT_FALSE(
        mapped_plane(complex, std::vector<char>(complex.cells.size(), 1), 0, 99).has_value());
}

}  // namespace
