// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/energy_detail.h"

#include <Eigen/LU>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace decomp::map {

namespace {

constexpr double kTheta = 0.25;
constexpr double kLeastDeterminant = 1e-9;  // of a tet behind the barrier

/// First guess of a cube root: the exponent is divided by three. Within 5 %.
double rough_cube_root(double value) {
    constexpr std::uint64_t kBias = 0x2A9F7893'782DA1CEULL;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) / 3 + kBias);
}

constexpr std::size_t kLanes = FoldoverEnergy::kLanes;
using Lane = FoldoverEnergy::Lane;
using Matrices = std::array<Lane, 9>;  // row-major

/// What the energy takes from the Jacobians of the eight tets.
struct Invariants {
    Matrices cofactors;  ///< the derivative of det
    Lane det;
    Lane norm;  ///< squared
};

inline void find_invariants(const Matrices& j, Invariants& out) {
    Matrices& c = out.cofactors;
    for (std::size_t i = 0; i < kLanes; ++i) {
        c[0][i] = j[4][i] * j[8][i] - j[5][i] * j[7][i];
        c[1][i] = j[5][i] * j[6][i] - j[3][i] * j[8][i];
        c[2][i] = j[3][i] * j[7][i] - j[4][i] * j[6][i];
        c[3][i] = j[2][i] * j[7][i] - j[1][i] * j[8][i];
        c[4][i] = j[0][i] * j[8][i] - j[2][i] * j[6][i];
        c[5][i] = j[1][i] * j[6][i] - j[0][i] * j[7][i];
        c[6][i] = j[1][i] * j[5][i] - j[2][i] * j[4][i];
        c[7][i] = j[2][i] * j[3][i] - j[0][i] * j[5][i];
        c[8][i] = j[0][i] * j[4][i] - j[1][i] * j[3][i];
        out.det[i] = j[0][i] * c[0][i] + j[1][i] * c[1][i] + j[2][i] * c[2][i];
        double sum = 0;
        for (std::size_t e = 0; e < 9; ++e) {
            sum += j[e][i] * j[e][i];
        }
        out.norm[i] = sum;
    }
}

inline void find_cube_roots(const Lane& values, Lane& roots) {
    for (std::size_t i = 0; i < kLanes; ++i) {
        roots[i] = rough_cube_root(values[i]);
    }
    for (int step = 0; step < 3; ++step) {  // Halley: 5e-2, 8e-5, 4e-13, then rounding
        for (std::size_t i = 0; i < kLanes; ++i) {
            const double cube = roots[i] * roots[i] * roots[i];
            roots[i] *= (cube + 2 * values[i]) / (2 * cube + values[i]);
        }
    }
}

/// Adds row r of the derivative by J to the derivative by the unknowns.
inline void scatter_row(const FoldoverEnergy::Block& block, const Matrices& stress, std::size_t r,
                        double* out) {
    std::array<Lane, 3> push;  // on corners 1, 2, 3 along axis r
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < kLanes; ++i) {
            double sum = 0;
            for (std::size_t e = 0; e < 3; ++e) {
                sum += stress[3 * r + e][i] * block.inverse[3 * k + e][i];
            }
            push[k][i] = sum;
        }
    }
    for (std::size_t i = 0; i < kLanes; ++i) {
        out[block.unknowns[r][i]] -= push[0][i] + push[1][i] + push[2][i];
        out[block.unknowns[3 + r][i]] += push[0][i];
        out[block.unknowns[6 + r][i]] += push[1][i];
        out[block.unknowns[9 + r][i]] += push[2][i];
    }
}

}  // namespace

FoldoverEnergy::FoldoverEnergy(std::span<const Eigen::Vector3d> shape,
                               std::span<const tets::Tet> tets,
                               std::span<const TetUnknowns> unknowns)
    : tets_(tets.size()) {
    double total = 0;
    std::vector<double> volumes(tets.size());
    blocks_.resize((tets.size() + kLanes - 1) / kLanes);
    for (std::size_t t = 0; t < kLanes * blocks_.size(); ++t) {
        // The last block is filled up with copies of the last tet that weigh nothing.
        const std::size_t source = std::min(t, tets.size() - 1);
        Block& block = blocks_[t / kLanes];
        const std::size_t lane = t % kLanes;
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) {
            edges.col(k) =
                shape[tets[source].at(static_cast<std::size_t>(k) + 1)] - shape[tets[source][0]];
        }
        const Eigen::Matrix3d inverse = edges.inverse();
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c) {
                block.inverse.at(3 * r + c).at(lane) =
                    inverse(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
            }
        }
        for (std::size_t u = 0; u < 12; ++u) {
            block.unknowns.at(u).at(lane) = unknowns[source].at(u);
        }
        if (t < tets.size()) {
            volumes[t] = edges.determinant() / 6;
            total += volumes[t];
        }
    }
    for (std::size_t t = 0; t < tets.size(); ++t) {
        blocks_[t / kLanes].weight.at(t % kLanes) = volumes[t] / total;
    }
}

void FoldoverEnergy::jacobians(const Block& block, const Eigen::VectorXd& x,
                               std::array<Lane, 9>& j) {
    const double* values = x.data();
    std::array<Lane, 9> edges;
    for (std::size_t d = 0; d < 3; ++d) {
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t i = 0; i < kLanes; ++i) {
                edges[3 * d + k][i] =
                    values[block.unknowns[3 * (k + 1) + d][i]] - values[block.unknowns[d][i]];
            }
        }
    }
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < kLanes; ++i) {
                j[3 * r + c][i] = edges[3 * r][i] * block.inverse[c][i] +
                                  edges[3 * r + 1][i] * block.inverse[3 + c][i] +
                                  edges[3 * r + 2][i] * block.inverse[6 + c][i];
            }
        }
    }
}

double FoldoverEnergy::operator()(const Eigen::VectorXd& x, double eps,
                                  Eigen::VectorXd& gradient) const {
    gradient.setZero(x.size());
    double* out = gradient.data();
    double energy = 0;
    for (const Block& block : blocks_) {
        std::array<Lane, 9> j;
        jacobians(block, x, j);
        Invariants invariants;
        find_invariants(j, invariants);
        const auto& [c, det, norm] = invariants;
        if (eps <= 0 && std::any_of(det.begin(), det.end(),
                                    [](double d) { return !(d > kLeastDeterminant); })) {
            return std::numeric_limits<double>::infinity();
        }
        Lane chi;
        Lane slope;  // d chi / d det
        for (std::size_t i = 0; i < kLanes; ++i) {
            const double root = std::sqrt(eps * eps + det[i] * det[i]);
            // For det < 0 the sum cancels; its conjugate does not.
            chi[i] = det[i] > 0 ? (det[i] + root) / 2 : eps * eps / (2 * (root - det[i]));
            slope[i] = 0.5 + det[i] / (2 * root);
        }
        Lane third;
        find_cube_roots(chi, third);
        Lane scale_j;
        Lane scale_c;
        for (std::size_t i = 0; i < kLanes; ++i) {
            const double w = block.weight[i];
            const double root2 = third[i] * third[i];
            const double f = norm[i] / root2;
            const double h = (1 + det[i] * det[i]) / chi[i];
            energy += w * ((1 - kTheta) * f + kTheta * h);
            scale_j[i] = w * (1 - kTheta) * 2 / root2;
            scale_c[i] = w * (kTheta * (2 * det[i] - h * slope[i]) / chi[i] -
                              (1 - kTheta) * 2 / 3 * f * slope[i] / chi[i]);
        }
        Matrices stress;  // the derivative of the energy by J
        for (std::size_t e = 0; e < 9; ++e) {
            for (std::size_t i = 0; i < kLanes; ++i) {
                stress[e][i] = scale_j[i] * j[e][i] + scale_c[i] * c[e][i];
            }
        }
        for (std::size_t r = 0; r < 3; ++r) {
            scatter_row(block, stress, r, out);
        }
    }
    return energy;
}

FoldoverEnergy::Determinants FoldoverEnergy::determinants(const Eigen::VectorXd& x) const {
    Determinants out{0, std::numeric_limits<double>::infinity()};
    std::size_t tet = 0;
    for (const Block& block : blocks_) {
        std::array<Lane, 9> j;
        jacobians(block, x, j);
        for (std::size_t i = 0; i < kLanes && tet < tets_; ++i, ++tet) {
            const double det = j[0][i] * (j[4][i] * j[8][i] - j[5][i] * j[7][i]) -
                               j[1][i] * (j[3][i] * j[8][i] - j[5][i] * j[6][i]) +
                               j[2][i] * (j[3][i] * j[7][i] - j[4][i] * j[6][i]);
            out.flips += det > 0 ? 0 : 1;
            out.least = std::min(out.least, det);
        }
    }
    return out;
}

}  // namespace decomp::map
