// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cells/cells.h"

#include "tests/support/pairs.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

namespace {

using decomp::cells::Cell;
using decomp::cells::CellComplex;
using decomp::cells::cells_of;
using decomp::cells::SheetPiece;
using tests::voxel_pair;
using tests::VoxelPair;

CellComplex cells(const VoxelPair& made) {
    auto out = cells_of(made.pair, made.lattice, {});
    EXPECT_TRUE(out.has_value()) << (out ? "" : out.error().text());
    return out ? std::move(*out) : CellComplex{};
}

double tet_volumes(const CellComplex& complex) {
    return std::accumulate(complex.tets.begin(), complex.tets.end(), 0.0,
                           [](double sum, const auto& tet) { return sum + tet.volume_mm3; });
}

TEST(Cells, AnLOfThreeVoxelsHasThreeCellsOfOneVoxelEach) {
    const VoxelPair made = voxel_pair({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 10, 2);
    const CellComplex complex = cells(made);
    ASSERT_EQ(complex.cells.size(), 3U);
    for (const Cell& cell : complex.cells) {
        EXPECT_NEAR(cell.volume_mm3, 1000, 1e-9);
    }
    EXPECT_EQ(complex.flipped, 0);
    EXPECT_EQ(complex.fragments, 0);
    EXPECT_EQ(complex.contacts.size(), 2U);
}

TEST(Cells, PiecesOfTheSheetHaveTheAreaOfTheFaceBetweenTheVoxels) {
    const VoxelPair made = voxel_pair({{0, 0, 0}, {1, 0, 0}}, 10, 2);
    const CellComplex complex = cells(made);
    double area = 0;
    for (const SheetPiece& piece : complex.pieces) {
        EXPECT_EQ(piece.axis, 0);
        EXPECT_EQ(piece.plane, 1);
        EXPECT_EQ(complex.cells[static_cast<std::size_t>(piece.lower)].index[0], 0);
        EXPECT_EQ(complex.cells[static_cast<std::size_t>(piece.upper)].index[0], 1);
        for (const std::uint32_t corner : piece.corners) {
            EXPECT_NEAR(complex.shape[corner].x(), 10, 1e-9);
        }
        area += piece.area_mm2;
    }
    EXPECT_NEAR(area, 100, 1e-9);
}

TEST(Cells, TetsAreDividedExactlyAtAPlaneBetweenTheirCorners) {
    VoxelPair made = voxel_pair({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 10, 1);
    made.lattice.planes = {{{0, 7.5, 20}, {0, 20}, {0, 10}}};
    const CellComplex complex = cells(made);
    EXPECT_NEAR(tet_volumes(complex), made.volume_mm3, 1e-9);
    ASSERT_EQ(complex.cells.size(), 2U);
    EXPECT_NEAR(complex.cells[0].volume_mm3, 1500, 1e-9);
    EXPECT_NEAR(complex.cells[1].volume_mm3, 1500, 1e-9);
    EXPECT_GT(complex.tets.size(), made.pair.tets.size());
    for (const auto& tet : complex.tets) {
        std::set<int> sides;
        for (const std::uint32_t corner : tet.corners) {
            const double x = complex.polycube[corner].x();
            sides.insert(x < 7.5 ? -1 : x > 7.5 ? 1 : 0);
        }
        EXPECT_FALSE(sides.contains(-1) && sides.contains(1));
    }
}

TEST(Cells, NeighboursAgreeOnTheFacesThatADivisionMakes) {
    // A conforming division has every inner triangle twice; its boundary then has the area of the
    // shape.
    VoxelPair made = voxel_pair({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 10, 2,
                                [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
                                    return {p.x() + 0.1 * p.z(), p.y(), p.z() - 0.07 * p.x()};
                                });
    made.lattice.planes = {{{0, 3.3, 11.7, 20}, {0, 6.1, 20}, {0, 4.9, 10}}};
    const CellComplex complex = cells(made);
    std::map<std::array<std::uint32_t, 3>, int> uses;
    for (const auto& tet : complex.tets) {
        for (std::size_t skip = 0; skip < 4; ++skip) {
            std::array<std::uint32_t, 3> key{};
            std::size_t n = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                if (k != skip) {
                    key.at(n++) = tet.corners.at(k);
                }
            }
            std::sort(key.begin(), key.end());
            ++uses[key];
        }
    }
    double boundary = 0;
    for (const auto& [t, count] : uses) {
        ASSERT_LE(count, 2);
        if (count == 1) {
            const Eigen::Vector3d& o = complex.shape[t[0]];
            boundary += (complex.shape[t[1]] - o).cross(complex.shape[t[2]] - o).norm() / 2;
        }
    }
    double surface = 0;
    for (const auto& t : made.surface.triangles) {
        const Eigen::Vector3d& o = made.surface.points[t[0]];
        surface += (made.surface.points[t[1]] - o).cross(made.surface.points[t[2]] - o).norm() / 2;
    }
    EXPECT_NEAR(boundary, surface, 1e-9 * surface);
}

TEST(Cells, ASmallCellJoinsTheNeighbourThatItTouchesMost) {
    VoxelPair made = voxel_pair({{0, 0, 0}, {1, 0, 0}}, 10, 2);
    made.lattice.planes[0] = {0, 0.1, 10, 20};
    const CellComplex complex = cells(made);
    ASSERT_EQ(complex.cells.size(), 2U);
    EXPECT_EQ(complex.fragments, 1);
    EXPECT_NEAR(complex.fragment_share, 10.0 / 2000, 1e-12);
    EXPECT_NEAR(complex.cells[0].volume_mm3, 1000, 1e-9);
}

TEST(Cells, PartsOfOneLatticeBlockThatDoNotTouchAreTwoCells) {
    // Both prongs of a U lie in the same block once its planes across the prongs are left out.
    VoxelPair made = voxel_pair({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}}, 10, 1);
    made.lattice.planes[0] = {0, 30};
    const CellComplex complex = cells(made);
    EXPECT_EQ(complex.cells.size(), 3U);
}

TEST(Cells, AFlippedTetIsCountedAndAMirroredPairIsNot) {
    VoxelPair made = voxel_pair({{0, 0, 0}}, 10, 2);
    // The middle point, dragged through the opposite side of its fan in polycube space alone.
    for (std::size_t i = 0; i < made.pair.shape.size(); ++i) {
        if (made.pair.shape[i].isApprox(Eigen::Vector3d(5, 5, 5))) {
            made.pair.polycube[i] = {5, 5, 11};
        }
    }
    const CellComplex dragged = cells(made);
    EXPECT_GT(dragged.flipped, 0);
    EXPECT_LT(dragged.flipped_share, 0.5);

    VoxelPair mirrored = voxel_pair({{0, 0, 0}, {1, 0, 0}}, 10, 1);
    for (Eigen::Vector3d& point : mirrored.pair.polycube) {
        point.y() = 10 - point.y();
    }
    EXPECT_EQ(cells(mirrored).flipped, 0);
}

TEST(Cells, BadPairsAndLatticesAreErrors) {
    const VoxelPair made = voxel_pair({{0, 0, 0}}, 10, 1);
    VoxelPair bad = made;
    bad.pair.polycube.pop_back();
    EXPECT_EQ(cells_of(bad.pair, bad.lattice, {}).error().code, "cells.bad_pair");
    bad = made;
    bad.pair.tets[0][2] = 99;
    EXPECT_EQ(cells_of(bad.pair, bad.lattice, {}).error().code, "cells.bad_pair");
    bad = made;
    bad.pair.shape[0].x() = NAN;
    EXPECT_EQ(cells_of(bad.pair, bad.lattice, {}).error().code, "cells.bad_pair");
    bad = made;
    bad.lattice.planes[1] = {0, 0};
    EXPECT_EQ(cells_of(bad.pair, bad.lattice, {}).error().code, "cells.bad_lattice");
}

}  // namespace
