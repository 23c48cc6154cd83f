// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/tets/tet_mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace decomp::map {

/// For each corner of a tet the numbers of its three unknowns: corner k, axis d at 3 k + d.
using TetUnknowns = std::array<std::uint32_t, 12>;

/// The foldover-free energy of a map (Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov 2021):
///   sum of vol / V ((1 - theta) |J|^2 / chi^(2/3) + theta (1 + det^2) / chi),
///   chi = (det + sqrt(eps^2 + det^2)) / 2, theta = 1/4,
/// finite for inverted tets while eps > 0, a barrier for eps = 0. It is 3 (1 - theta) + 2 theta for
/// a rotation. Tets are worked on in blocks so that the compiler can use vector registers.
class FoldoverEnergy {
  public:
    static constexpr std::size_t kLanes = 8;
    using Lane = std::array<double, kLanes>;

    /// Eight tets: inverse edge matrices of the shape, weights, unknowns.
    struct Block {
        std::array<Lane, 9> inverse{};  ///< row-major
        Lane weight{};
        std::array<std::array<std::uint32_t, kLanes>, 12> unknowns{};
    };

    /// @param shape     points of the shape; every tet positive
    /// @param unknowns  one row for each tet
    FoldoverEnergy(std::span<const Eigen::Vector3d> shape, std::span<const tets::Tet> tets,
                   std::span<const TetUnknowns> unknowns);

    /// The energy at x, and its gradient (same size as x, overwritten). Infinite where eps = 0 and
    /// a tet has no volume left; the gradient then means nothing. Cost: about 50 ns a tet.
    double operator()(const Eigen::VectorXd& x, double eps, Eigen::VectorXd& gradient) const;

    struct Determinants {
        std::size_t flips = 0;  ///< not above 0
        double least = 0;
    };

    [[nodiscard]] Determinants determinants(const Eigen::VectorXd& x) const;

  private:
    /// J of the eight tets at x, row-major.
    static void jacobians(const Block& block, const Eigen::VectorXd& x, std::array<Lane, 9>& j);

    std::size_t tets_ = 0;
    std::vector<Block> blocks_;
};

}  // namespace decomp::map
