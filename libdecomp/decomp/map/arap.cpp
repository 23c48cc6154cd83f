// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/arap_detail.h"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/LU>
#include <Eigen/SparseCore>

#include <cmath>

namespace decomp::map {

namespace {

constexpr double kRegularisation = 1e-7;  // holds the mean; of the largest diagonal entry
constexpr double kSolveTolerance = 1e-5;
constexpr int kSolveIterations = 300;
constexpr int kRotationSteps = 12;
constexpr double kRotationDone = 1e-7;
constexpr double kTinyDenominator = 1e-9;

using Gradients = Eigen::Matrix<double, 3, 4>;
using Matrix = Eigen::SparseMatrix<double>;
using Solver = Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper,
                                        Eigen::DiagonalPreconditioner<double>>;

/// Turns q towards the rotation nearest to j: the torque that aligns the axes, step by step.
void fit_rotation(const Eigen::Matrix3d& j, Eigen::Quaterniond& q) {
    for (int step = 0; step < kRotationSteps; ++step) {
        const Eigen::Matrix3d r = q.toRotationMatrix();
        const Eigen::Vector3d torque =
            r.col(0).cross(j.col(0)) + r.col(1).cross(j.col(1)) + r.col(2).cross(j.col(2));
        const double weight =
            std::abs(r.col(0).dot(j.col(0)) + r.col(1).dot(j.col(1)) + r.col(2).dot(j.col(2))) +
            kTinyDenominator;
        const Eigen::Vector3d turn = torque / weight;
        const double angle = turn.norm();
        if (angle < kRotationDone) {
            break;
        }
        q = Eigen::AngleAxisd(angle, turn / angle) * q;
        q.normalize();
    }
}

/// The unknowns of one axis, renumbered from 0.
struct Axis {
    std::vector<std::uint32_t> of_point;
    std::vector<std::uint32_t> unknown;  ///< number among all
    Matrix laplacian;
};

Axis axis_system(const tets::TetMesh& mesh, const std::vector<Gradients>& gradients,
                 const std::vector<double>& volumes, const Unknowns& unknowns, std::size_t d) {
    Axis axis;
    std::vector<std::int64_t> number(unknowns.count, -1);
    for (const auto& row : unknowns.of_point) {
        std::int64_t& mine = number[row.at(d)];
        if (mine < 0) {
            mine = static_cast<std::int64_t>(axis.unknown.size());
            axis.unknown.push_back(row.at(d));
        }
        axis.of_point.push_back(static_cast<std::uint32_t>(mine));
    }
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(16 * mesh.tets.size());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const Eigen::Matrix4d local = volumes[t] * (gradients[t].transpose() * gradients[t]);
        for (int a = 0; a < 4; ++a) {
            for (int b = 0; b < 4; ++b) {
                entries.emplace_back(axis.of_point[mesh.tets[t].at(static_cast<std::size_t>(a))],
                                     axis.of_point[mesh.tets[t].at(static_cast<std::size_t>(b))],
                                     local(a, b));
            }
        }
    }
    const auto size = static_cast<Eigen::Index>(axis.unknown.size());
    axis.laplacian.resize(size, size);
    axis.laplacian.setFromTriplets(entries.begin(), entries.end());
    const double most = axis.laplacian.diagonal().maxCoeff();
    for (Eigen::Index i = 0; i < size; ++i) {
        axis.laplacian.coeffRef(i, i) += kRegularisation * most;
    }
    return axis;
}

}  // namespace

Eigen::VectorXd arap_start(const tets::TetMesh& mesh, const Unknowns& unknowns, int rounds) {
    const std::size_t tets = mesh.tets.size();
    std::vector<Gradients> gradients(tets);
    std::vector<double> volumes(tets);
    for (std::size_t t = 0; t < tets; ++t) {
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) {
            edges.col(k) = mesh.points[mesh.tets[t].at(static_cast<std::size_t>(k) + 1)] -
                           mesh.points[mesh.tets[t][0]];
        }
        volumes[t] = edges.determinant() / 6;
        const Eigen::Matrix3d inverse = edges.inverse();
        gradients[t].rightCols<3>() = inverse.transpose();
        gradients[t].col(0) = -inverse.transpose().rowwise().sum();
    }
    // Means of the shared coordinates to start from.
    Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns.count));
    Eigen::VectorXd sharers = x;
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        for (std::size_t d = 0; d < 3; ++d) {
            const auto u = static_cast<Eigen::Index>(unknowns.of_point[p].at(d));
            x[u] += mesh.points[p][static_cast<Eigen::Index>(d)];
            sharers[u] += 1;
        }
    }
    x = x.cwiseQuotient(sharers);

    std::array<Axis, 3> axes;
    std::array<Solver, 3> solvers;
    for (std::size_t d = 0; d < 3; ++d) {
        axes.at(d) = axis_system(mesh, gradients, volumes, unknowns, d);
        solvers.at(d).setMaxIterations(kSolveIterations);
        solvers.at(d).setTolerance(kSolveTolerance);
        solvers.at(d).compute(axes.at(d).laplacian);
    }
    std::vector<Eigen::Quaterniond> rotations(tets, Eigen::Quaterniond::Identity());
    for (int round = 0; round < rounds; ++round) {
        std::array<Eigen::VectorXd, 3> right;
        for (std::size_t d = 0; d < 3; ++d) {
            const auto size = static_cast<Eigen::Index>(axes.at(d).unknown.size());
            right.at(d) = Eigen::VectorXd::Zero(size);
            const double hold = kRegularisation * axes.at(d).laplacian.diagonal().maxCoeff();
            for (Eigen::Index i = 0; i < size; ++i) {
                right.at(d)[i] = hold * x[axes.at(d).unknown[static_cast<std::size_t>(i)]];
            }
        }
        for (std::size_t t = 0; t < tets; ++t) {
            if (round > 0) {
                Eigen::Matrix<double, 3, 4> mapped;
                for (int k = 0; k < 4; ++k) {
                    const auto& row =
                        unknowns.of_point[mesh.tets[t].at(static_cast<std::size_t>(k))];
                    mapped.col(k) = Eigen::Vector3d(x[row[0]], x[row[1]], x[row[2]]);
                }
                fit_rotation(mapped * gradients[t].transpose(), rotations[t]);
            }
            const Eigen::Matrix<double, 3, 4> pull =
                volumes[t] * (rotations[t].toRotationMatrix() * gradients[t]);
            for (std::size_t d = 0; d < 3; ++d) {
                for (std::size_t k = 0; k < 4; ++k) {
                    right.at(d)[axes.at(d).of_point[mesh.tets[t].at(k)]] +=
                        pull(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(k));
                }
            }
        }
        for (std::size_t d = 0; d < 3; ++d) {
            const Axis& axis = axes.at(d);
            Eigen::VectorXd guess(static_cast<Eigen::Index>(axis.unknown.size()));
            for (std::size_t i = 0; i < axis.unknown.size(); ++i) {
                guess[static_cast<Eigen::Index>(i)] = x[axis.unknown[i]];
            }
            const Eigen::VectorXd solved = solvers.at(d).solveWithGuess(right.at(d), guess);
            for (std::size_t i = 0; i < axis.unknown.size(); ++i) {
                x[axis.unknown[i]] = solved[static_cast<Eigen::Index>(i)];
            }
        }
    }
    return x;
}

}  // namespace decomp::map
