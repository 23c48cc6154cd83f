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
using Corners = Eigen::Matrix<double, 3, 4>;
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

/// Of each tet: the gradients of its corners' hat functions, one column each, and the volume.
struct Elements {
    std::vector<Gradients> gradients;
    std::vector<double> volumes;  ///< mm^3
};

Elements elements_of(const tets::TetMesh& mesh) {
    const std::size_t tets = mesh.tets.size();
    Elements out{std::vector<Gradients>(tets), std::vector<double>(tets)};
    for (std::size_t t = 0; t < tets; ++t) {
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) {
            edges.col(k) = mesh.points[mesh.tets[t].at(static_cast<std::size_t>(k) + 1)] -
                           mesh.points[mesh.tets[t][0]];
        }
        out.volumes[t] = edges.determinant() / 6;
        const Eigen::Matrix3d inverse = edges.inverse();
        out.gradients[t].rightCols<3>() = inverse.transpose();
        out.gradients[t].col(0) = -inverse.transpose().rowwise().sum();
    }
    return out;
}

/// The unknowns of one axis, renumbered from 0.
struct Axis {
    std::vector<std::uint32_t> of_point;
    std::vector<std::uint32_t> unknown;  ///< number among all
    Matrix laplacian;
};

Axis axis_system(const tets::TetMesh& mesh, const Elements& elements, const Unknowns& unknowns,
                 std::size_t d) {
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
        const Gradients& gradients = elements.gradients[t];
        const Eigen::Matrix4d local = elements.volumes[t] * (gradients.transpose() * gradients);
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

/// Means of the shared coordinates, to start from.
Eigen::VectorXd shared_means(const tets::TetMesh& mesh, const Unknowns& unknowns) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns.count));
    Eigen::VectorXd sharers = x;
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        for (std::size_t d = 0; d < 3; ++d) {
            const auto u = static_cast<Eigen::Index>(unknowns.of_point[p].at(d));
            x[u] += mesh.points[p][static_cast<Eigen::Index>(d)];
            sharers[u] += 1;
        }
    }
    return x.cwiseQuotient(sharers);
}

/// The corners of a tet at x, one column each.
Corners corners_at(const Eigen::VectorXd& x, const Unknowns& unknowns, const tets::Tet& tet) {
    Corners corners;
    for (int k = 0; k < 4; ++k) {
        const auto& row = unknowns.of_point[tet.at(static_cast<std::size_t>(k))];
        corners.col(k) = Eigen::Vector3d(x[row[0]], x[row[1]], x[row[2]]);
    }
    return corners;
}

/// The right-hand sides of the three axes.
using Sides = std::array<Eigen::VectorXd, 3>;

/// What the regularisation asks: stay at x.
Sides held_sides(const std::array<Axis, 3>& axes, const Eigen::VectorXd& x) {
    Sides right;
    for (std::size_t d = 0; d < 3; ++d) {
        const auto size = static_cast<Eigen::Index>(axes.at(d).unknown.size());
        right.at(d) = Eigen::VectorXd::Zero(size);
        const double hold = kRegularisation * axes.at(d).laplacian.diagonal().maxCoeff();
        for (Eigen::Index i = 0; i < size; ++i) {
            right.at(d)[i] = hold * x[axes.at(d).unknown[static_cast<std::size_t>(i)]];
        }
    }
    return right;
}

void add_pull(const Gradients& pull, const tets::Tet& tet, const std::array<Axis, 3>& axes,
              Sides& right) {
    for (std::size_t d = 0; d < 3; ++d) {
        for (std::size_t k = 0; k < 4; ++k) {
            right.at(d)[axes.at(d).of_point[tet.at(k)]] +=
                pull(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(k));
        }
    }
}

/// Moves the unknowns of one axis to where its system is solved, from where they are.
void solve_axis(const Axis& axis, const Solver& solver, const Eigen::VectorXd& right,
                Eigen::VectorXd& x) {
    Eigen::VectorXd guess(static_cast<Eigen::Index>(axis.unknown.size()));
    for (std::size_t i = 0; i < axis.unknown.size(); ++i) {
        guess[static_cast<Eigen::Index>(i)] = x[axis.unknown[i]];
    }
    const Eigen::VectorXd solved = solver.solveWithGuess(right, guess);
    for (std::size_t i = 0; i < axis.unknown.size(); ++i) {
        x[axis.unknown[i]] = solved[static_cast<Eigen::Index>(i)];
    }
}

}  // namespace

Eigen::VectorXd arap_start(const tets::TetMesh& mesh, const Unknowns& unknowns, int rounds) {
    const std::size_t tets = mesh.tets.size();
    const Elements elements = elements_of(mesh);
    const std::vector<Gradients>& gradients = elements.gradients;
    Eigen::VectorXd x = shared_means(mesh, unknowns);
    std::array<Axis, 3> axes;
    std::array<Solver, 3> solvers;
    for (std::size_t d = 0; d < 3; ++d) {
        axes.at(d) = axis_system(mesh, elements, unknowns, d);
        solvers.at(d).setMaxIterations(kSolveIterations);
        solvers.at(d).setTolerance(kSolveTolerance);
        solvers.at(d).compute(axes.at(d).laplacian);
    }
    std::vector<Eigen::Quaterniond> rotations(tets, Eigen::Quaterniond::Identity());
    for (int round = 0; round < rounds; ++round) {
        Sides right = held_sides(axes, x);
        for (std::size_t t = 0; t < tets; ++t) {
            if (round > 0) {
                const Corners mapped = corners_at(x, unknowns, mesh.tets[t]);
                fit_rotation(mapped * gradients[t].transpose(), rotations[t]);
            }
            add_pull(elements.volumes[t] * (rotations[t].toRotationMatrix() * gradients[t]),
                     mesh.tets[t], axes, right);
        }
        for (std::size_t d = 0; d < 3; ++d) {
            solve_axis(axes.at(d), solvers.at(d), right.at(d), x);
        }
    }
    return x;
}

}  // namespace decomp::map
