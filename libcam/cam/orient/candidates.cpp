// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/orient/candidates.h"

#include "decomp/mesh/flats.h"
#include "decomp/mesh/measure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace cam::orient {

namespace {

constexpr double kOnHull = 1e-6;       // of the diagonal
constexpr double kSameNormal = 1e-3;   // radians
constexpr double kMeantAsAxis = 1e-9;  // radians
constexpr double kLeastShare = 0.005;  // of the surface: a flat worth standing on

/// The facets of one side of one cut plane.
struct CutFace {
    std::int32_t plane;
    Eigen::Vector3d reference;  // normal of the first facet: tells the two sides apart
    Eigen::Vector3d sum;        // of doubled area normals
    Eigen::Vector3d some_point;
};

std::vector<CutFace> cut_faces(const decomp::part::Part& part) {
    std::vector<CutFace> faces;
    for (std::size_t i = 0; i < part.mesh.triangles.size(); ++i) {
        if (!part.sources[i].is_cut()) {
            continue;
        }
        const Eigen::Vector3d normal = decomp::mesh::double_area_normal(part.mesh, i);
        const auto face = std::find_if(faces.begin(), faces.end(), [&](const CutFace& f) {
            return f.plane == part.sources[i].plane && f.reference.dot(normal) > 0;
        });
        if (face != faces.end()) {
            face->sum += normal;
        } else if (normal.squaredNorm() > 0) {
            faces.push_back({part.sources[i].plane, normal, normal,
                             part.mesh.points[part.mesh.triangles[i][0]]});
        }
    }
    std::stable_sort(faces.begin(), faces.end(),
                     [](const CutFace& a, const CutFace& b) { return a.plane < b.plane; });
    return faces;
}

/// What was meant as an axis is one, so that such poses are exact.
Eigen::Vector3d snapped_to_axis(const Eigen::Vector3d& direction) {
    int axis = 0;
    direction.cwiseAbs().maxCoeff(&axis);
    Eigen::Vector3d unit = Eigen::Vector3d::Zero();
    unit[axis] = direction[axis] < 0 ? -1 : 1;
    return (unit - direction).norm() < kMeantAsAxis ? unit : direction;
}

bool on_hull(const decomp::mesh::TriMesh& mesh, const Eigen::Vector3d& normal,
             const Eigen::Vector3d& point, double slack) {
    const double limit = normal.dot(point) + slack;
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                       [&](const decomp::mesh::Triangle& t) {
                           return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
                               return normal.dot(mesh.points[v]) <= limit;
                           });
                       });
}

}  // namespace

std::vector<Stand> stands(const decomp::part::Part& part, Flats flats) {
    std::vector<Stand> out;
    const auto add = [&](const Stand& stand) {
        const bool known = std::any_of(out.begin(), out.end(), [&](const Stand& other) {
            return (other.down - stand.down).norm() < kSameNormal;
        });
        if (!known) {
            out.push_back(stand);
        }
    };
    const std::vector<CutFace> faces = cut_faces(part);
    const double slack = kOnHull * decomp::mesh::diagonal_mm(part.mesh);
    for (const CutFace& face : faces) {
        const Eigen::Vector3d normal = snapped_to_axis(face.sum.normalized());
        if (on_hull(part.mesh, normal, face.some_point, slack)) {
            add({normal, face.plane, true, true});
        }
    }
    if (flats == Flats::Left && !out.empty()) {
        return out;
    }
    for (const auto& flat : decomp::mesh::large_flats(part.mesh, {.min_share = kLeastShare})) {
        if (flat.on_hull) {
            add({flat.normal, -1, false, true});
        }
    }
    if (out.empty() || faces.empty()) {
        for (const int axis : {2, 0, 1}) {
            for (const double sign : {-1.0, 1.0}) {
                add({sign * Eigen::Vector3d::Unit(axis), -1, false, false});
            }
        }
    }
    return out;
}

}  // namespace cam::orient
