// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/collapse.h"

#include "decomp/mesh/measure.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace decomp::solid {

namespace {

constexpr double kMostTurn = 0.3;     ///< cosine between a triangle's normals before and after
constexpr double kThinnestMm = 1e-4;  ///< height of a triangle
constexpr double kRimWeight = 10;     ///< of the outline of a flat region against its surroundings
constexpr std::size_t kCancelEvery = 4096;

/// What a point may do.
enum class Role {
    Free,    ///< among triangles alone: may go to any neighbour
    Rim,     ///< between one flat region and triangles: along the rim
    Inside,  ///< of a flat region: anywhere in it
    Fixed,
};

/// Squared distances to planes, summed (Garland and Heckbert 1997).
struct Quadric {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double c = 0;
    double weight = 0;

    void add(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double w) {
        const double offset = normal.dot(point);
        a += w * normal * normal.transpose();
        b -= w * offset * normal;
        c += w * offset * offset;
        weight += w;
    }

    void add(const Quadric& other) {
        a += other.a;
        b += other.b;
        c += other.c;
        weight += other.weight;
    }

    /// Mean squared distance.
    [[nodiscard]] double at(const Eigen::Vector3d& p) const {
        return weight > 0 ? std::max(0.0, (p.dot(a * p) + 2 * b.dot(p) + c) / weight) : 0;
    }
};

/// Squared distance from a point to a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
double squared_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const Eigen::Vector3d ab = b - a;
    const Eigen::Vector3d ac = c - a;
    const Eigen::Vector3d ap = p - a;
    const double d1 = ab.dot(ap);
    const double d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) {
        return ap.squaredNorm();
    }
    const Eigen::Vector3d bp = p - b;
    const double d3 = ab.dot(bp);
    const double d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) {
        return bp.squaredNorm();
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return (ap - d1 / (d1 - d3) * ab).squaredNorm();
    }
    const Eigen::Vector3d cp = p - c;
    const double d5 = ab.dot(cp);
    const double d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) {
        return cp.squaredNorm();
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        return (ap - d2 / (d2 - d6) * ac).squaredNorm();
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).squaredNorm();
    }
    const double sum = va + vb + vc;
    return (ap - vb / sum * ab - vc / sum * ac).squaredNorm();
}

class Collapser {
  public:
    Collapser(const part::Part& part, const Adjacency& adjacency, const Regions& regions,
              double watched_mm)
        : points_(part.mesh.points),
          adjacency_(adjacency),
          regions_(regions),
          limit_(watched_mm * watched_mm) {
        out_.triangles = part.mesh.triangles;
        out_.alive.assign(out_.triangles.size(), true);
        watched_.resize(out_.triangles.size());
        around_.resize(points_.size());
        for (std::uint32_t t = 0; t < out_.triangles.size(); ++t) {
            for (const std::uint32_t p : out_.triangles[t]) {
                around_[p].push_back(t);
            }
        }
        gone_.assign(points_.size(), false);
        stamp_.assign(points_.size(), 0);
        give_roles();
        make_quadrics(part.mesh);
    }

    Result<Collapsed> collapse(std::size_t max_faces, const Run& run) {
        std::size_t faces = count_faces();
        for (std::uint32_t v = 0; v < points_.size(); ++v) {
            propose(v);
        }
        std::size_t steps = 0;
        while (!queue_.empty() && faces > max_faces) {
            if (++steps % kCancelEvery == 0 && run.cancelled()) {
                return cancelled();
            }
            const Candidate candidate = queue_.top();
            queue_.pop();
            if (candidate.stamp == stamp_[candidate.from] && !gone_[candidate.to] &&
                is_allowed(candidate.from, candidate.to)) {
                faces -= apply(candidate.from, candidate.to);
            }
        }
        return std::move(out_);
    }

  private:
    struct Candidate {
        double cost = 0;
        std::uint32_t from = 0;
        std::uint32_t to = 0;
        std::uint32_t stamp = 0;

        bool operator<(const Candidate& other) const {
            return std::tie(cost, from, to) > std::tie(other.cost, other.from, other.to);
        }
    };

    [[nodiscard]] std::int32_t label(std::uint32_t t) const { return regions_.of[t]; }

    [[nodiscard]] bool is_curved(std::int32_t region) const {
        return !std::holds_alternative<PlaneSurface>(
            regions_.all[static_cast<std::size_t>(region)].surface);
    }

    void give_roles() {
        role_.assign(points_.size(), Role::Free);
        for (std::uint32_t v = 0; v < points_.size(); ++v) {
            std::int32_t plane = -1;
            bool free = false;
            for (const std::uint32_t t : around_[v]) {
                const std::int32_t r = label(t);
                if (r < 0) {
                    free = true;
                } else if ((plane >= 0 && plane != r) || is_curved(r)) {
                    role_[v] = Role::Fixed;
                } else {
                    plane = r;
                }
            }
            if (role_[v] != Role::Fixed && plane >= 0) {
                role_[v] = free ? Role::Rim : Role::Inside;
            }
        }
    }

    void make_quadrics(const mesh::TriMesh& mesh) {
        quadric_.resize(points_.size());
        for (std::uint32_t t = 0; t < out_.triangles.size(); ++t) {
            const Eigen::Vector3d twice = mesh::double_area_normal(mesh, t);
            const double area = twice.norm() / 2;
            if (area <= 0) {
                continue;
            }
            const Eigen::Vector3d normal = twice / (2 * area);
            for (const std::uint32_t p : out_.triangles[t]) {
                quadric_[p].add(normal, points_[p], area);
            }
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t h = 3 * t + k;
                if (label(t) < 0 || label(adjacency_.twin[h] / 3) == label(t)) {
                    continue;
                }
                const Eigen::Vector3d& a = points_[start_of(mesh, h)];
                const Eigen::Vector3d& b = points_[end_of(mesh, h)];
                const Eigen::Vector3d wall = (b - a).cross(normal);
                if (wall.norm() > 0) {
                    const double weight = kRimWeight * (b - a).squaredNorm();
                    quadric_[start_of(mesh, h)].add(wall.normalized(), a, weight);
                    quadric_[end_of(mesh, h)].add(wall.normalized(), a, weight);
                }
            }
        }
    }

    [[nodiscard]] std::size_t count_faces() const {
        std::vector<bool> met(regions_.all.size(), false);
        std::size_t faces = 0;
        for (const std::int32_t r : regions_.of) {
            if (r < 0) {
                ++faces;
            } else if (!met[static_cast<std::size_t>(r)]) {
                met[static_cast<std::size_t>(r)] = true;
                ++faces;
            }
        }
        return faces;
    }

    [[nodiscard]] std::vector<std::uint32_t> neighbours_of(std::uint32_t v) const {
        std::vector<std::uint32_t> out;
        for (const std::uint32_t t : around_[v]) {
            for (const std::uint32_t p : out_.triangles[t]) {
                if (p != v) {
                    out.push_back(p);
                }
            }
        }
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        return out;
    }

    /// On the rim of a flat region: one triangle in it, one outside.
    [[nodiscard]] bool is_rim_edge(std::uint32_t v, std::uint32_t u) const {
        int inside = 0;
        int outside = 0;
        for (const std::uint32_t t : around_[v]) {
            const mesh::Triangle& c = out_.triangles[t];
            if (std::find(c.begin(), c.end(), u) != c.end()) {
                ++(label(t) < 0 ? outside : inside);
            }
        }
        return inside == 1 && outside == 1;
    }

    void propose(std::uint32_t v) {
        if (gone_[v] || role_[v] == Role::Fixed) {
            return;
        }
        for (const std::uint32_t u : neighbours_of(v)) {
            if (role_[v] == Role::Rim && !is_rim_edge(v, u)) {
                continue;
            }
            const double cost = role_[v] == Role::Inside ? -1 : quadric_[v].at(points_[u]);
            if (cost <= limit_) {
                queue_.push({cost, v, u, stamp_[v]});
            }
        }
    }

    [[nodiscard]] std::vector<std::uint32_t> kept_of(std::uint32_t v, std::uint32_t u) const {
        std::vector<std::uint32_t> kept;
        for (const std::uint32_t t : around_[v]) {
            const mesh::Triangle& c = out_.triangles[t];
            if (std::find(c.begin(), c.end(), u) == c.end()) {
                kept.push_back(t);
            }
        }
        return kept;
    }

    [[nodiscard]] mesh::Triangle moved(std::uint32_t t, std::uint32_t v, std::uint32_t u) const {
        mesh::Triangle c = out_.triangles[t];
        std::replace(c.begin(), c.end(), v, u);
        return c;
    }

    [[nodiscard]] Eigen::Vector3d twice_area(const mesh::Triangle& c) const {
        return (points_[c[1]] - points_[c[0]]).cross(points_[c[2]] - points_[c[0]]);
    }

    [[nodiscard]] bool is_allowed(std::uint32_t v, std::uint32_t u) {
        const std::vector<std::uint32_t> of_v = neighbours_of(v);
        if (!std::binary_search(of_v.begin(), of_v.end(), u) ||
            (role_[v] == Role::Rim && !is_rim_edge(v, u))) {
            return false;
        }
        // The surface stays a surface: only the two triangles at the edge go.
        const std::vector<std::uint32_t> of_u = neighbours_of(u);
        std::vector<std::uint32_t> common;
        std::set_intersection(of_v.begin(), of_v.end(), of_u.begin(), of_u.end(),
                              std::back_inserter(common));
        if (common.size() != 2 || around_[common[0]].size() <= 3 ||
            around_[common[1]].size() <= 3) {
            return false;
        }
        const std::vector<std::uint32_t> kept = kept_of(v, u);
        return keeps_shape(kept, v, u) && keeps_watch(kept, v, u);
    }

    [[nodiscard]] bool keeps_shape(const std::vector<std::uint32_t>& kept, std::uint32_t v,
                                   std::uint32_t u) const {
        for (const std::uint32_t t : kept) {
            const mesh::Triangle after = moved(t, v, u);
            const Eigen::Vector3d now = twice_area(after);
            const double area = now.norm();
            const double longest = std::max({(points_[after[0]] - points_[after[1]]).norm(),
                                             (points_[after[1]] - points_[after[2]]).norm(),
                                             (points_[after[2]] - points_[after[0]]).norm()});
            if (label(t) >= 0) {
                const auto& plane = std::get<PlaneSurface>(
                    regions_.all[static_cast<std::size_t>(label(t))].surface);
                if (now.dot(plane.normal) <= kThinnestMm * kThinnestMm) {
                    return false;
                }
                continue;
            }
            const Eigen::Vector3d before = twice_area(out_.triangles[t]);
            if (area <= kThinnestMm * longest ||
                now.dot(before) < kMostTurn * area * before.norm()) {
                return false;
            }
        }
        return true;
    }

    /// Everything that was removed here, and v itself, lies near the triangles that remain.
    [[nodiscard]] bool keeps_watch(const std::vector<std::uint32_t>& kept, std::uint32_t v,
                                   std::uint32_t u) {
        homes_.clear();
        std::vector<std::uint32_t> open;
        std::vector<mesh::Triangle> after;
        for (const std::uint32_t t : kept) {
            if (label(t) < 0) {
                open.push_back(t);
                after.push_back(moved(t, v, u));
            }
        }
        if (role_[v] == Role::Inside) {
            return true;
        }
        if (open.empty()) {
            return false;
        }
        const auto settle = [&](std::uint32_t w) {
            double nearest = INFINITY;
            std::uint32_t home = open[0];
            for (std::size_t i = 0; i < open.size(); ++i) {
                const double d = squared_distance(points_[w], points_[after[i][0]],
                                                  points_[after[i][1]], points_[after[i][2]]);
                if (d < nearest) {
                    nearest = d;
                    home = open[i];
                }
            }
            homes_.emplace_back(w, home);
            return nearest <= limit_;
        };
        // And the other way: what takes the place lies near what was there.
        for (const mesh::Triangle& c : after) {
            const Eigen::Vector3d& p = points_[c[0]];
            const Eigen::Vector3d& q = points_[c[1]];
            const Eigen::Vector3d& r = points_[c[2]];
            for (const Eigen::Vector3d& sample :
                 {Eigen::Vector3d((p + q) / 2), Eigen::Vector3d((q + r) / 2),
                  Eigen::Vector3d((r + p) / 2), Eigen::Vector3d((p + q + r) / 3)}) {
                double nearest = INFINITY;
                for (const std::uint32_t t : around_[v]) {
                    const mesh::Triangle& old = out_.triangles[t];
                    nearest = std::min(nearest, squared_distance(sample, points_[old[0]],
                                                                 points_[old[1]], points_[old[2]]));
                }
                if (nearest > limit_) {
                    return false;
                }
            }
        }
        if (!settle(v)) {
            return false;
        }
        for (const std::uint32_t t : around_[v]) {
            for (const std::uint32_t w : watched_[t]) {
                if (!settle(w)) {
                    return false;
                }
            }
        }
        return true;
    }

    /// The number of faces that went.
    std::size_t apply(std::uint32_t v, std::uint32_t u) {
        std::size_t removed = 0;
        const std::vector<std::uint32_t> ring = neighbours_of(v);
        const std::vector<std::uint32_t> star = around_[v];
        if (role_[v] != Role::Inside) {
            for (const std::uint32_t t : star) {
                watched_[t].clear();
            }
        }
        for (const std::uint32_t t : star) {
            mesh::Triangle& c = out_.triangles[t];
            if (std::find(c.begin(), c.end(), u) != c.end()) {
                out_.alive[t] = false;
                removed += label(t) < 0 ? 1U : 0U;
                for (const std::uint32_t p : c) {
                    std::erase(around_[p], t);
                }
                continue;
            }
            std::replace(c.begin(), c.end(), v, u);
            around_[u].push_back(t);
        }
        for (const auto& [w, home] : homes_) {
            watched_[home].push_back(w);
        }
        around_[v].clear();
        gone_[v] = true;
        ++out_.removed_points;
        quadric_[u].add(quadric_[v]);
        for (const std::uint32_t p : ring) {
            ++stamp_[p];
        }
        for (const std::uint32_t p : ring) {
            propose(p);
        }
        return removed;
    }

    const std::vector<Eigen::Vector3d>& points_;
    const Adjacency& adjacency_;
    const Regions& regions_;
    double limit_;
    Collapsed out_;
    std::vector<std::vector<std::uint32_t>> around_;   ///< triangles at each point
    std::vector<std::vector<std::uint32_t>> watched_;  ///< removed points near each triangle
    std::vector<std::pair<std::uint32_t, std::uint32_t>> homes_;
    std::vector<Role> role_;
    std::vector<Quadric> quadric_;
    std::vector<bool> gone_;
    std::vector<std::uint32_t> stamp_;
    std::priority_queue<Candidate> queue_;
};

}  // namespace

Result<Collapsed> collapse(const part::Part& part, const Adjacency& adjacency,
                           const Regions& regions, double watched_mm, std::size_t max_faces,
                           const Run& run) {
    return Collapser(part, adjacency, regions, watched_mm).collapse(max_faces, run);
}

}  // namespace decomp::solid
