// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/cone_fit.h"

#include <Eigen/Dense>

#include <cmath>

namespace decomp::solid {

namespace {

constexpr int kUnknowns = 6;  ///< centre across (2), axis tilted (2), half angle, offset
constexpr double kSettled = 1e-14;
constexpr double kDependent = 1e-9;  ///< what remains of a row that others imply
constexpr double kCylinder = 1e-6;   ///< radians of a half angle

using Row = Eigen::Matrix<double, kUnknowns, 1>;

/// The derivatives of the distance at p.
struct Slope {
    Row row;
    double distance = 0;
};

/// The limits as linear equations of the step; those that others imply are left out.
class Equations {
  public:
    void add(const Row& row, double wanted) {
        Row rest = row.normalized();
        for (int pass = 0; pass < 2; ++pass) {
            for (const Row& before : orthonormal_) {
                rest -= before * before.dot(rest);
            }
        }
        if (rest.norm() > kDependent) {
            orthonormal_.push_back(rest.normalized());
            rows_.push_back(row);
            wanted_.push_back(wanted);
        }
    }

    /// The step of least squares that obeys them (Lagrange).
    [[nodiscard]] Row solve(const Eigen::Matrix<double, kUnknowns, kUnknowns>& squares,
                            const Row& right) const {
        const auto count = static_cast<Eigen::Index>(rows_.size());
        Eigen::MatrixXd system = Eigen::MatrixXd::Zero(kUnknowns + count, kUnknowns + count);
        Eigen::VectorXd wanted = Eigen::VectorXd::Zero(kUnknowns + count);
        system.topLeftCorner<kUnknowns, kUnknowns>() = squares;
        wanted.head<kUnknowns>() = right;
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto at = static_cast<std::size_t>(i);
            system.row(kUnknowns + i).head<kUnknowns>() = rows_[at].transpose();
            system.col(kUnknowns + i).head<kUnknowns>() = rows_[at];
            wanted[kUnknowns + i] = wanted_[at];
        }
        return system.fullPivLu().solve(wanted).head<kUnknowns>();
    }

  private:
    std::vector<Row> orthonormal_;
    std::vector<Row> rows_;
    std::vector<double> wanted_;
};

/// A cone with the frame across its axis in which steps are counted.
struct Frame {
    explicit Frame(const ConeFit& of)
        : cone(of), u(reference_direction(of.axis)), v(of.axis.cross(u)) {}

    [[nodiscard]] Slope slope_at(const Eigen::Vector3d& p) const {
        const Eigen::Vector3d from = p - cone.centre;
        const double height = cone.axis.dot(from);
        const Eigen::Vector3d across = from - height * cone.axis;
        const double radius = across.norm();
        const Eigen::Vector3d out = radius > 0 ? Eigen::Vector3d(across / radius) : u;
        const double c = std::cos(cone.half_angle);
        const double s = std::sin(cone.half_angle);
        Slope slope;
        slope.distance = c * radius - s * height - cone.offset_mm;
        slope.row << -c * out.dot(u), -c * out.dot(v), -out.dot(u) * (c * height + s * radius),
            -out.dot(v) * (c * height + s * radius), -s * radius - c * height, -1;
        return slope;
    }

    [[nodiscard]] Row centre_row(const Eigen::Vector3d& n) const {
        Row row;
        row << n.dot(u), n.dot(v), 0, 0, 0, 0;
        return row;
    }

    [[nodiscard]] Row axis_row(const Eigen::Vector3d& n) const {
        Row row;
        row << 0, 0, n.dot(u), n.dot(v), 0, 0;
        return row;
    }

    [[nodiscard]] Equations equations(const ConeLimits& limits) const {
        Equations equations;
        for (int i = 0; i < 4; ++i) {
            if (i < 2 ? limits.fixed_centre : limits.fixed_direction) {
                equations.add(Row::Unit(i), 0);
            }
        }
        for (const PlaneSurface& plane : limits.along) {
            equations.add(axis_row(plane.normal), -plane.normal.dot(cone.axis));
            equations.add(centre_row(plane.normal),
                          plane.offset_mm - plane.normal.dot(cone.centre));
        }
        for (const PlaneSurface& plane : limits.touched) {
            Row angle = axis_row(plane.normal);
            angle[4] = limits.side * std::cos(cone.half_angle);
            equations.add(angle,
                          -plane.normal.dot(cone.axis) - limits.side * std::sin(cone.half_angle));
            Row offset = centre_row(plane.normal);
            offset[5] = limits.side;
            equations.add(offset, plane.offset_mm - plane.normal.dot(cone.centre) -
                                      limits.side * cone.offset_mm);
        }
        return equations;
    }

    ConeFit cone;
    Eigen::Vector3d u;
    Eigen::Vector3d v;
};

}  // namespace

double ConeFit::distance_mm(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d from = p - centre;
    const double height = axis.dot(from);
    return std::cos(half_angle) * (from - height * axis).norm() - std::sin(half_angle) * height -
           offset_mm;
}

ConeSurface ConeFit::surface() const {
    return {centre - axis * (offset_mm / std::sin(half_angle)), axis, half_angle};
}

std::optional<ConeFit> cone_inside(const std::vector<PlaneSurface>& planes,
                                   const Eigen::Vector3d& middle) {
    // All normals stand at one angle to the axis: their ends lie in a plane square to it.
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const PlaneSurface& plane : planes) {
        mean += plane.normal / static_cast<double>(planes.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const PlaneSurface& plane : planes) {
        spread += (plane.normal - mean) * (plane.normal - mean).transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    ConeFit cone;
    cone.axis = solver.eigenvectors().col(0);
    const Eigen::Vector3d u = reference_direction(cone.axis);
    const Eigen::Vector3d v = cone.axis.cross(u);
    // normal . x = offset for x on the touched cone, whose radius square to it is `touch`.
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const PlaneSurface& plane : planes) {
        const Eigen::Vector3d row(plane.normal.dot(u), plane.normal.dot(v), 1);
        squares += row * row.transpose();
        right += row * (plane.offset_mm - plane.normal.dot(middle));
    }
    const Eigen::Vector3d found = squares.fullPivLu().solve(right);
    const double side = found.z() > 0 ? 1 : -1;
    cone.centre = middle + found.x() * u + found.y() * v;
    cone.offset_mm = std::abs(found.z());
    double lean = -side * mean.dot(cone.axis);
    if (lean < 0) {
        cone.axis = -cone.axis;
        lean = -lean;
    }
    if (!found.allFinite() || lean < kCylinder || lean >= 1) {
        return std::nullopt;
    }
    cone.half_angle = std::asin(lean);
    return cone;
}

ConeFit fit_cone(const std::vector<Eigen::Vector3d>& points, const ConeFit& start,
                 const ConeLimits& limits, int rounds) {
    ConeFit cone = start;
    for (int round = 0; round < rounds; ++round) {
        const Frame frame(cone);
        Eigen::Matrix<double, kUnknowns, kUnknowns> squares;
        squares.setZero();
        Row right = Row::Zero();
        for (const Eigen::Vector3d& p : points) {
            const Slope slope = frame.slope_at(p);
            squares += slope.row * slope.row.transpose();
            right -= slope.row * slope.distance;
        }
        const Row step = frame.equations(limits).solve(squares, right);
        if (!step.allFinite()) {
            return cone;
        }
        cone.centre += step[0] * frame.u + step[1] * frame.v;
        cone.axis = (cone.axis + step[2] * frame.u + step[3] * frame.v).normalized();
        cone.half_angle += step[4];
        cone.offset_mm += step[5];
        if (step.norm() <= kSettled * (1 + std::abs(cone.offset_mm))) {
            break;
        }
    }
    return cone;
}

}  // namespace decomp::solid
