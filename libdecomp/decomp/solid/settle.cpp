// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/measure.h"
#include "decomp/solid/boundary.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>

namespace decomp::solid {

namespace {

/// A corner that stays farther from one of its surfaces than this is no corner of theirs.
constexpr double kOffMm = 1e-5;
constexpr double kExact = 1e-13;        ///< of the coordinates
constexpr double kOneDirection = 1e-4;  ///< between normals of surfaces that touch
constexpr double kTouching = 1e-3;      ///< between normals of a torus and what it touches
constexpr int kRounds = 12;

/// For each corner the regions that meet there, sorted.
std::vector<std::vector<std::int32_t>> regions_at_corners(const mesh::TriMesh& mesh,
                                                          const Regions& regions,
                                                          const FaceMap& faces) {
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
    for (std::vector<std::int32_t>& own : meeting) {
        std::sort(own.begin(), own.end());
    }
    return meeting;
}

struct Point {
    Eigen::Vector3d at;
    double off = 0;  ///< the largest distance from a surface
};

/// A surface through the circle in which a torus touches another near a point; nothing where it
/// does not. Touching surfaces alone leave a point free to slide across that circle.
std::optional<Surface> touching_circle(const TorusSurface& torus, const Surface& other,
                                       const Eigen::Vector3d& at) {
    if (normal_at(torus, at).cross(normal_at(other, at)).norm() > kTouching) {
        return std::nullopt;
    }
    if (const auto* plane = std::get_if<PlaneSurface>(&other)) {
        return plane->normal.cross(torus.axis).norm() < kTouching
                   ? std::optional<Surface>(
                         CylinderSurface{torus.centre, torus.axis, torus.major_mm})
                   : std::nullopt;
    }
    if (!std::holds_alternative<CylinderSurface>(other)) {
        return std::nullopt;
    }
    const Eigen::Vector3d axis = axis_of(other).axis;
    if (std::abs(axis.dot(torus.axis)) < kTouching) {
        return PlaneSurface{axis, axis.dot(torus.centre)};
    }
    return axis.cross(torus.axis).norm() < kTouching
               ? std::optional<Surface>(PlaneSurface{torus.axis, torus.axis.dot(torus.centre)})
               : std::nullopt;
}

/// By Gauss-Newton: each step is the shortest that the tangent planes ask for.
Point common_point(const Eigen::Vector3d& start, const std::vector<Surface>& meeting) {
    const auto count = static_cast<Eigen::Index>(meeting.size());
    Point found{start};
    for (int round = 0; round < kRounds; ++round) {
        Eigen::MatrixXd gradients(count, 3);
        Eigen::VectorXd residuals(count);
        for (Eigen::Index i = 0; i < count; ++i) {
            const Surface& surface = meeting[static_cast<std::size_t>(i)];
            gradients.row(i) = normal_at(surface, found.at).transpose();
            residuals[i] = distance_mm(surface, found.at);
        }
        found.off = residuals.cwiseAbs().maxCoeff();
        if (found.off <= kExact * (1 + found.at.cwiseAbs().maxCoeff())) {
            break;
        }
        Eigen::JacobiSVD<Eigen::MatrixXd> svd(gradients, Eigen::ComputeThinU | Eigen::ComputeThinV);
        svd.setThreshold(kOneDirection);
        found.at -= svd.solve(residuals);
    }
    return found;
}

/// The regions of one corner.
class Meeting {
  public:
    Meeting(const Regions& regions, const std::vector<std::int32_t>& own)
        : regions_(regions), own_(own) {}

    /// Where the surfaces meet; where a torus touches one of them, on the circle in which it does.
    [[nodiscard]] Point common_point(const Eigen::Vector3d& start) const {
        std::vector<Surface> meeting;
        meeting.reserve(own_.size());
        for (const std::int32_t r : own_) {
            meeting.push_back(region(r).surface);
        }
        Point found = solid::common_point(start, meeting);
        std::vector<Surface> circles;
        for (const Surface& a : meeting) {
            for (const Surface& b : meeting) {
                const auto* torus = std::get_if<TorusSurface>(&a);
                if (torus == nullptr || &a == &b) {
                    continue;
                }
                if (const auto through = touching_circle(*torus, b, found.at)) {
                    circles.push_back(*through);
                }
            }
        }
        if (circles.empty()) {
            return found;
        }
        meeting.insert(meeting.end(), circles.begin(), circles.end());
        return solid::common_point(found.at, meeting);
    }

    /// How far the corner may move: triangles stay behind a curved surface by its sagitta.
    [[nodiscard]] double allowed_mm(double tolerance_mm) const {
        double allowed_mm = tolerance_mm;
        for (const std::int32_t r : own_) {
            allowed_mm = std::max(allowed_mm, 1.01 * region(r).sagitta_mm);
        }
        return allowed_mm;
    }

    [[nodiscard]] std::int32_t smallest() const {
        return *std::min_element(own_.begin(), own_.end(), [&](std::int32_t a, std::int32_t b) {
            return region(a).area_mm2 < region(b).area_mm2;
        });
    }

  private:
    [[nodiscard]] const Region& region(std::int32_t r) const {
        return regions_.all[static_cast<std::size_t>(r)];
    }

    const Regions& regions_;
    const std::vector<std::int32_t>& own_;
};

/// Of each face: its region's surface, or the plane through a triangle alone.
std::vector<Surface> surfaces_of_faces(const mesh::TriMesh& mesh, const Regions& regions,
                                       const FaceMap& faces,
                                       const std::vector<Eigen::Vector3d>& points) {
    std::vector<Surface> surfaces;
    surfaces.reserve(faces.region.size());
    for (std::size_t f = 0; f < faces.region.size(); ++f) {
        if (faces.region[f] >= 0) {
            surfaces.push_back(regions.all[static_cast<std::size_t>(faces.region[f])].surface);
            continue;
        }
        const mesh::Triangle& t = mesh.triangles[faces.triangle[f]];
        const Eigen::Vector3d& a = points[t[0]];
        PlaneSurface plane;
        plane.normal = (points[t[1]] - a).cross(points[t[2]] - a).normalized();
        plane.offset_mm = plane.normal.dot((a + points[t[1]] + points[t[2]]) / 3);
        surfaces.emplace_back(plane);
    }
    return surfaces;
}

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
    const auto meeting = regions_at_corners(mesh, regions, faces);
    std::vector<bool> refused(regions.all.size(), false);
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        if (meeting[p].empty()) {
            continue;
        }
        const Meeting corner(regions, meeting[p]);
        const Point found = corner.common_point(mesh.points[p]);
        const double moved = (found.at - mesh.points[p]).norm();
        if (!(found.off <= kOffMm) || !(moved <= corner.allowed_mm(tolerance_mm))) {
            refused[static_cast<std::size_t>(corner.smallest())] = true;
            continue;
        }
        settled.points[p] = found.at;
        settled.farthest_mm = std::max(settled.farthest_mm, moved);
        settled.off_mm = std::max(settled.off_mm, found.off);
    }
    for (std::size_t r = 0; r < refused.size(); ++r) {
        if (refused[r]) {
            settled.refused.push_back(static_cast<std::int32_t>(r));
        }
    }
    settled.surfaces = surfaces_of_faces(mesh, regions, faces, settled.points);
    return settled;
}

}  // namespace decomp::solid
