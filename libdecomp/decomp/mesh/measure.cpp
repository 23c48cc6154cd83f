// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/measure.h"

#include <cmath>
#include <utility>

namespace decomp::mesh {

namespace {

/// Neumaier's compensated sum.
class Sum {
  public:
    void add(double value) {
        const double total = total_ + value;
        rest_ += std::abs(total_) >= std::abs(value) ? (total_ - total) + value
                                                     : (value - total) + total_;
        total_ = total;
    }

    [[nodiscard]] double value() const { return total_ + rest_; }

  private:
    double total_ = 0;
    double rest_ = 0;
};

}  // namespace

Eigen::AlignedBox3d bounds(const TriMesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            box.extend(mesh.points[corner]);
        }
    }
    return box;
}

double diagonal_mm(const TriMesh& mesh) {
    const Eigen::AlignedBox3d box = bounds(mesh);
    return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

double volume_mm3(const TriMesh& mesh) {
    if (mesh.triangles.empty()) {
        return 0;
    }
    const Eigen::Vector3d centre = bounds(mesh).center();
    Sum six_volumes;
    for (const Triangle& t : mesh.triangles) {
        const Eigen::Vector3d a = mesh.points[t[0]] - centre;
        const Eigen::Vector3d b = mesh.points[t[1]] - centre;
        const Eigen::Vector3d c = mesh.points[t[2]] - centre;
        six_volumes.add(a.dot(b.cross(c)));
    }
    return six_volumes.value() / 6.0;
}

double area_mm2(const TriMesh& mesh) {
    Sum doubled;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        doubled.add(double_area_normal(mesh, i).norm());
    }
    return doubled.value() / 2.0;
}

Eigen::Vector3d double_area_normal(const TriMesh& mesh, std::size_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]);
}

TriMesh transformed(const TriMesh& mesh, const Eigen::Affine3d& map) {
    TriMesh out = mesh;
    for (Eigen::Vector3d& point : out.points) {
        point = map * point;
    }
    if (map.linear().determinant() < 0) {
        for (Triangle& t : out.triangles) {
            std::swap(t[1], t[2]);
        }
    }
    return out;
}

}  // namespace decomp::mesh
