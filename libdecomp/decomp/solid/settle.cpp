// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/measure.h"
#include "decomp/solid/boundary.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace decomp::solid {

namespace {

/// A corner that stays farther from one of its surfaces than this is no corner of theirs.
constexpr double kOffMm = 1e-6;
constexpr double kExact = 1e-13;        ///< of the coordinates
constexpr double kOneDirection = 1e-4;  ///< between normals of surfaces that touch
constexpr int kRounds = 12;

}  // namespace

FaceMap map_faces(const mesh::TriMesh& mesh, const Adjacency& adjacency, const Regions& regions) {
    FaceMap faces;
    faces.of.resize(mesh.triangles.size());
    std::vector<std::int32_t> face_of_region(regions.all.size(), -1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::int32_t region = regions.of[t];
        std::int32_t face = region < 0 ? -1 : face_of_region[static_cast<std::size_t>(region)];
        if (face < 0) {
            face = static_cast<std::int32_t>(faces.region.size());
            faces.region.push_back(region);
            faces.triangle.push_back(t);
            if (region >= 0) {
                face_of_region[static_cast<std::size_t>(region)] = face;
            }
        }
        faces.of[t] = face;
    }
    // A point is a corner unless exactly one line between two regions passes it, or none does.
    std::vector<int> lines(mesh.points.size(), 0);
    std::vector<std::int32_t> low(mesh.points.size(), INT32_MAX);
    std::vector<std::int32_t> high(mesh.points.size(), -1);
    faces.corner.assign(mesh.points.size(), false);
    for (std::uint32_t h = 0; h < adjacency.twin.size(); ++h) {
        const std::uint32_t p = start_of(mesh, h);
        const std::int32_t face = faces.of[h / 3];
        if (faces.region[static_cast<std::size_t>(face)] < 0) {
            faces.corner[p] = true;
        }
        if (face != faces.of[adjacency.twin[h] / 3]) {
            ++lines[p];
        }
        low[p] = std::min(low[p], face);
        high[p] = std::max(high[p], face);
    }
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t p : mesh.triangles[t]) {
            const bool third = faces.of[t] != low[p] && faces.of[t] != high[p];
            faces.corner[p] = faces.corner[p] || third || (lines[p] != 0 && lines[p] != 2);
        }
    }
    return faces;
}

Settled settle(const mesh::TriMesh& mesh, const Regions& regions, const FaceMap& faces,
               double tolerance_mm) {
    Settled settled;
    settled.points = mesh.points;
    std::vector<std::vector<std::int32_t>> meeting(mesh.points.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::int32_t region = regions.of[t];
        for (const std::uint32_t p : mesh.triangles[t]) {
            if (region >= 0 && faces.corner[p] &&
                std::find(meeting[p].begin(), meeting[p].end(), region) == meeting[p].end()) {
                meeting[p].push_back(region);
            }
        }
    }
    std::vector<bool> refused(regions.all.size(), false);
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        auto& own = meeting[p];
        if (own.empty()) {
            continue;
        }
        std::sort(own.begin(), own.end());
        double allowed_mm = tolerance_mm;
        for (const std::int32_t r : own) {
            allowed_mm =
                std::max(allowed_mm, 1.01 * regions.all[static_cast<std::size_t>(r)].sagitta_mm);
        }
        const auto count = static_cast<Eigen::Index>(own.size());
        Eigen::Vector3d at = mesh.points[p];
        double off = 0;
        for (int round = 0; round < kRounds; ++round) {
            Eigen::MatrixXd gradients(count, 3);
            Eigen::VectorXd residuals(count);
            for (Eigen::Index i = 0; i < count; ++i) {
                const Surface& surface =
                    regions.all[static_cast<std::size_t>(own[static_cast<std::size_t>(i)])].surface;
                gradients.row(i) = normal_at(surface, at).transpose();
                residuals[i] = distance_mm(surface, at);
            }
            off = residuals.cwiseAbs().maxCoeff();
            if (off <= kExact * (1 + at.cwiseAbs().maxCoeff())) {
                break;
            }
            Eigen::JacobiSVD<Eigen::MatrixXd> svd(gradients,
                                                  Eigen::ComputeThinU | Eigen::ComputeThinV);
            svd.setThreshold(kOneDirection);
            at -= svd.solve(residuals);
        }
        const double moved = (at - mesh.points[p]).norm();
        if (!(off <= kOffMm) || !(moved <= allowed_mm)) {
            // The smallest of those that meet gives way.
            const auto smallest =
                std::min_element(own.begin(), own.end(), [&](std::int32_t a, std::int32_t b) {
                    return regions.all[static_cast<std::size_t>(a)].area_mm2 <
                           regions.all[static_cast<std::size_t>(b)].area_mm2;
                });
            refused[static_cast<std::size_t>(*smallest)] = true;
            continue;
        }
        settled.points[p] = at;
        settled.farthest_mm = std::max(settled.farthest_mm, moved);
        settled.off_mm = std::max(settled.off_mm, off);
    }
    for (std::size_t r = 0; r < refused.size(); ++r) {
        if (refused[r]) {
            settled.refused.push_back(static_cast<std::int32_t>(r));
        }
    }
    for (std::size_t f = 0; f < faces.region.size(); ++f) {
        if (faces.region[f] >= 0) {
            settled.surfaces.push_back(
                regions.all[static_cast<std::size_t>(faces.region[f])].surface);
            continue;
        }
        const mesh::Triangle& t = mesh.triangles[faces.triangle[f]];
        const Eigen::Vector3d& a = settled.points[t[0]];
        PlaneSurface plane;
        plane.normal = (settled.points[t[1]] - a).cross(settled.points[t[2]] - a).normalized();
        plane.offset_mm = plane.normal.dot((a + settled.points[t[1]] + settled.points[t[2]]) / 3);
        settled.surfaces.emplace_back(plane);
    }
    return settled;
}

}  // namespace decomp::solid
