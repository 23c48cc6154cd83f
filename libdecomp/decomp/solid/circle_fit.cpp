// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/circle_fit.h"

#include <Eigen/Dense>

#include <cmath>

namespace decomp::solid {

namespace {

constexpr double kStraight = 1e-9;  ///< sine of the angle at a corner
constexpr double kSettled = 1e-14;  ///< step against the radius

}  // namespace

std::optional<CircleFit> circle_through(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                        const Eigen::Vector2d& c) {
    Eigen::Matrix2d sides;
    sides.row(0) = (b - a).transpose();
    sides.row(1) = (c - a).transpose();
    const double twice_area = sides.determinant();
    if (std::abs(twice_area) <= kStraight * sides.squaredNorm()) {
        return std::nullopt;
    }
    const Eigen::Vector2d from_a =
        sides.inverse() * Eigen::Vector2d((b - a).squaredNorm() / 2, (c - a).squaredNorm() / 2);
    return CircleFit{a + from_a, from_a.norm()};
}

CircleFit fit_circle(const std::vector<Eigen::Vector2d>& points, const CircleFit& start,
                     const std::vector<TangentLine>& touched) {
    constexpr int kRounds = 20;
    CircleFit circle = start;
    for (int round = 0; round < kRounds; ++round) {
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        for (const Eigen::Vector2d& p : points) {
            const Eigen::Vector2d d = p - circle.centre;
            const double distance = d.norm();
            if (distance == 0) {
                continue;
            }
            const Eigen::Vector3d row(-d.x() / distance, -d.y() / distance, -1);
            squares += row * row.transpose();
            right -= row * (distance - circle.radius);
        }
        // Lagrange: the step keeps the circle on its lines.
        const auto lines = static_cast<Eigen::Index>(touched.size());
        Eigen::MatrixXd system = Eigen::MatrixXd::Zero(3 + lines, 3 + lines);
        Eigen::VectorXd wanted = Eigen::VectorXd::Zero(3 + lines);
        system.topLeftCorner<3, 3>() = squares;
        wanted.head<3>() = right;
        for (Eigen::Index i = 0; i < lines; ++i) {
            const TangentLine& line = touched[static_cast<std::size_t>(i)];
            const Eigen::Vector3d row(line.normal.x(), line.normal.y(), line.side);
            system.row(3 + i).head<3>() = row.transpose();
            system.col(3 + i).head<3>() = row;
            wanted[3 + i] =
                line.offset - line.normal.dot(circle.centre) - line.side * circle.radius;
        }
        const Eigen::Vector3d step = system.fullPivLu().solve(wanted).head<3>();
        if (!step.allFinite()) {
            return circle;
        }
        circle.centre += step.head<2>();
        circle.radius += step.z();
        if (step.norm() <= kSettled * (1 + circle.radius)) {
            break;
        }
    }
    return circle;
}

}  // namespace decomp::solid
