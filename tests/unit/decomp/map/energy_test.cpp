// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/rng.h"
#include "decomp/map/energy_detail.h"
#include "tests/support/tet_shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace decomp;

struct Block {
    tets::TetMesh mesh = tests::voxel_tets({2, 1, 1}, [](int, int, int) { return true; });
    std::vector<map::TetUnknowns> rows;
    Eigen::VectorXd x;

    Block() {
        for (const tets::Tet& tet : mesh.tets) {
            map::TetUnknowns row{};
            for (std::size_t k = 0; k < 4; ++k) {
                for (std::uint32_t d = 0; d < 3; ++d) {
                    row.at(3 * k + d) = 3 * tet.at(k) + d;
                }
            }
            rows.push_back(row);
        }
        x.resize(3 * static_cast<Eigen::Index>(mesh.points.size()));
        for (std::size_t p = 0; p < mesh.points.size(); ++p) {
            x.segment<3>(3 * static_cast<Eigen::Index>(p)) = mesh.points[p];
        }
    }

    [[nodiscard]] map::FoldoverEnergy energy() const { return {mesh.points, mesh.tets, rows}; }
};

TEST(Energy, OfARotationIsItsLeastValueWithoutGradient) {
    Block block;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 1).normalized()).toRotationMatrix();
    for (Eigen::Index i = 0; i < block.x.size(); i += 3) {
        block.x.segment<3>(i) = turn * block.x.segment<3>(i);
    }
    Eigen::VectorXd gradient;
    EXPECT_NEAR(block.energy()(block.x, 0, gradient), 0.75 * 3 + 0.25 * 2, 1e-12);
    EXPECT_LT(gradient.norm(), 1e-12);
}

TEST(Energy, GradientIsTheSlopeForUprightAndInvertedTets) {
    Block block;
    Rng rng(7);
    for (Eigen::Index i = 0; i < block.x.size(); ++i) {
        block.x[i] += rng.uniform(-0.6, 0.6);
    }
    const auto energy = block.energy();
    ASSERT_GT(energy.determinants(block.x).flips, 0U);
    constexpr double kEps = 0.1;
    constexpr double kStep = 1e-6;
    Eigen::VectorXd gradient;
    Eigen::VectorXd unused;
    energy(block.x, kEps, gradient);
    for (Eigen::Index i = 0; i < block.x.size(); ++i) {
        Eigen::VectorXd ahead = block.x;
        Eigen::VectorXd behind = block.x;
        ahead[i] += kStep;
        behind[i] -= kStep;
        const double slope =
            (energy(ahead, kEps, unused) - energy(behind, kEps, unused)) / (2 * kStep);
        EXPECT_NEAR(gradient[i], slope, 1e-5 * (1 + std::abs(slope)));
    }
}

TEST(Energy, IsABarrierWithoutEpsilonAndFiniteWith) {
    Block block;
    block.x[0] += 5;
    Eigen::VectorXd gradient;
    EXPECT_TRUE(std::isinf(block.energy()(block.x, 0, gradient)));
    EXPECT_TRUE(std::isfinite(block.energy()(block.x, 1e-3, gradient)));
}

}  // namespace
