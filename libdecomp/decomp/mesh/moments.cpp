// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/moments.h"

#include "decomp/mesh/measure.h"

#include <Eigen/Eigenvalues>

namespace decomp::mesh {

Moments moments(const TriMesh& mesh) {
    Moments out;
    if (mesh.triangles.empty()) {
        return out;
    }
    const Eigen::Vector3d origin = bounds(mesh).center();
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    double six_volumes = 0;
    for (const Triangle& t : mesh.triangles) {
        const Eigen::Vector3d a = mesh.points[t[0]] - origin;
        const Eigen::Vector3d b = mesh.points[t[1]] - origin;
        const Eigen::Vector3d c = mesh.points[t[2]] - origin;
        const Eigen::Vector3d sum = a + b + c;
        const double six = a.dot(b.cross(c));
        six_volumes += six;
        first += six / 4 * sum;
        // Integral of x x^T over the tetrahedron 0abc: 6V/120 (aa + bb + cc + ss).
        second +=
            six / 20 *
            (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
    if (six_volumes <= 0) {
        out.centre = origin;
        return out;
    }
    out.volume_mm3 = six_volumes / 6;
    const Eigen::Vector3d mean = first / six_volumes;
    out.centre = origin + mean;
    out.covariance = second / six_volumes - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(out.covariance);
    for (int i = 0; i < 3; ++i) {
        Eigen::Vector3d axis = solver.eigenvectors().col(2 - i);
        int largest = 0;
        axis.cwiseAbs().maxCoeff(&largest);
        out.axes.col(i) = axis[largest] < 0 ? Eigen::Vector3d(-axis) : axis;
    }
    return out;
}

}  // namespace decomp::mesh
