// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/boundary.h"
#include "decomp/solid/intersect.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace decomp::solid {

double turn_between(double from, double to) {
    const double turn = std::remainder(to - from, 2 * std::numbers::pi);
    return turn == -std::numbers::pi ? std::numbers::pi : turn;
}

AxisLine axis_of(const Surface& surface) {
    if (const auto* cylinder = std::get_if<CylinderSurface>(&surface)) {
        return {cylinder->origin, cylinder->axis};
    }
    if (const auto* cone = std::get_if<ConeSurface>(&surface)) {
        return {cone->apex, cone->axis};
    }
    if (const auto* torus = std::get_if<TorusSurface>(&surface)) {
        return {torus->centre, torus->axis};
    }
    return {};
}

double angle_about(const Surface& surface, const Eigen::Vector3d& p) {
    const AxisLine line = axis_of(surface);
    const Eigen::Vector3d u = reference_direction(line.axis);
    return std::atan2(line.axis.cross(u).dot(p - line.origin), u.dot(p - line.origin));
}

namespace {

constexpr double kKernelMm = 1e-7;  ///< what CAD kernels count as one point
constexpr double kAlike = 3;        ///< ratio of areas

/// About the middle of the tube, from its outermost point.
double tube_angle(const TorusSurface& torus, const Eigen::Vector3d& p) {
    const double height = torus.axis.dot(p - torus.centre);
    return std::atan2(height, (p - torus.centre - height * torus.axis).norm() - torus.major_mm);
}

/// Walks along the borders of faces on a mesh and makes edges and loops of them.
class Walker {
  public:
    Walker(const mesh::TriMesh& mesh, const Adjacency& adjacency, const Regions& regions,
           const FaceMap& faces, const Settled& settled)
        : mesh_(mesh), adjacency_(adjacency), regions_(regions), faces_(faces), settled_(settled) {}

    Bounded walk() {
        make_vertices();
        make_edges();
        if (refused_.empty()) {
            make_faces();
        }
        if (refused_.empty()) {
            make_shells();
        }
        out_.solid.tolerance_mm = std::max(kKernelMm, 2 * std::max(settled_.off_mm, off_mm_));
        out_.refused.assign(refused_.begin(), refused_.end());
        return std::move(out_);
    }

  private:
    [[nodiscard]] std::int32_t face_at(std::uint32_t h) const { return faces_.of[h / 3]; }

    [[nodiscard]] bool is_border(std::uint32_t h) const {
        return face_at(h) != face_at(adjacency_.twin[h]);
    }

    /// The border of the same face that follows this one, turning about the point between them.
    [[nodiscard]] std::uint32_t next_border(std::uint32_t h) const {
        std::uint32_t n = Adjacency::next(h);
        while (!is_border(n)) {
            n = Adjacency::next(adjacency_.twin[n]);
        }
        return n;
    }

    void make_vertices() {
        vertex_of_.assign(mesh_.points.size(), -1);
        for (std::size_t p = 0; p < mesh_.points.size(); ++p) {
            if (faces_.corner[p]) {
                vertex_of_[p] = static_cast<std::int32_t>(out_.solid.vertices.size());
                out_.solid.vertices.push_back(settled_.points[p]);
            }
        }
    }

    /// Whichever of the two regions can better be spared.
    void refuse(std::int32_t face_a, std::int32_t face_b) {
        const std::int32_t a = faces_.region[static_cast<std::size_t>(face_a)];
        const std::int32_t b = faces_.region[static_cast<std::size_t>(face_b)];
        const auto curved = [&](std::int32_t r) {
            return r >= 0 && !std::holds_alternative<PlaneSurface>(
                                 regions_.all[static_cast<std::size_t>(r)].surface);
        };
        const auto kind = [&](std::int32_t r) {
            return regions_.all[static_cast<std::size_t>(r)].surface.index();
        };
        const auto area = [&](std::int32_t r) {
            return regions_.all[static_cast<std::size_t>(r)].area_mm2;
        };
        if (a < 0 && b < 0) {
            return;
        }
        if (a < 0 || b < 0) {
            refused_.insert(std::max(a, b));
        } else if (curved(a) && curved(b) && kind(a) != kind(b)) {
            // A cylinder is seldom a mistake; the rings of a rounded corner are cones one by one.
            refused_.insert(kind(a) > kind(b) ? a : b);
        } else if (curved(a) && curved(b) &&
                   std::max(area(a), area(b)) < kAlike * std::min(area(a), area(b))) {
            // The sectors of a ring look like cylinders one by one: none of them is.
            refused_.insert(a);
            refused_.insert(b);
        } else if (curved(a) != curved(b)) {
            refused_.insert(curved(a) ? a : b);
        } else {
            refused_.insert(area(a) < area(b) ? a : b);
        }
    }

    void make_edges() {
        const auto count = static_cast<std::uint32_t>(adjacency_.twin.size());
        use_of_.assign(count, {});
        // Between corners first; what is then left goes round without one.
        for (std::uint32_t h = 0; h < count; ++h) {
            if (is_border(h) && use_of_[h].edge < 0 && faces_.corner[start_of(mesh_, h)]) {
                make_edge(h);
            }
        }
        for (std::uint32_t h = 0; h < count; ++h) {
            if (is_border(h) && use_of_[h].edge < 0) {
                make_edge(h);
            }
        }
    }

    void make_edge(std::uint32_t first) {
        std::vector<std::uint32_t> chain{first};
        while (!faces_.corner[end_of(mesh_, chain.back())]) {
            const std::uint32_t n = next_border(chain.back());
            if (n == first) {
                break;
            }
            chain.push_back(n);
        }
        std::vector<Eigen::Vector3d> path;
        path.reserve(chain.size() + 1);
        for (const std::uint32_t h : chain) {
            path.push_back(settled_.points[start_of(mesh_, h)]);
        }
        path.push_back(settled_.points[end_of(mesh_, chain.back())]);
        const std::int32_t left = face_at(first);
        const std::int32_t right = face_at(adjacency_.twin[first]);
        const bool closed = !faces_.corner[start_of(mesh_, first)];
        const std::int32_t from = vertex_of_[start_of(mesh_, first)];
        const std::int32_t to = vertex_of_[end_of(mesh_, chain.back())];
        const auto curve =
            curve_along(settled_.surfaces[static_cast<std::size_t>(left)],
                        settled_.surfaces[static_cast<std::size_t>(right)], path, closed);
        const auto number = static_cast<std::int32_t>(out_.solid.edges.size());
        Edge edge;
        if (curve) {
            edge = {curve->curve, from, to, curve->t0, curve->t1};
            off_mm_ = std::max(off_mm_, curve->off_mm);
        } else {
            refuse(left, right);
        }
        out_.solid.edges.push_back(edge);
        for (const std::uint32_t h : chain) {
            use_of_[h] = {number, false};
            use_of_[adjacency_.twin[h]] = {number, true};
        }
    }

    struct Ring {
        Loop loop;
        std::vector<Eigen::Vector3d> path;
        int round = 0;
        double area = 0;
    };

    [[nodiscard]] Ring ring_from(std::uint32_t first, const Surface& surface,
                                 std::vector<bool>& seen) const {
        Ring ring;
        std::uint32_t h = first;
        do {
            seen[h] = true;
            const EdgeUse use = use_of_[h];
            if (ring.loop.empty() || ring.loop.back().edge != use.edge ||
                faces_.corner[start_of(mesh_, h)]) {
                ring.loop.push_back(use);
            }
            ring.path.push_back(settled_.points[start_of(mesh_, h)]);
            h = next_border(h);
        } while (h != first);
        // The walk may have begun in the middle of an edge.
        if (ring.loop.size() > 1 && ring.loop.front().edge == ring.loop.back().edge &&
            ring.loop.front().reversed == ring.loop.back().reversed) {
            ring.loop.pop_back();
        }
        if (const auto* plane = std::get_if<PlaneSurface>(&surface)) {
            Eigen::Vector3d twice = Eigen::Vector3d::Zero();
            for (std::size_t i = 0; i < ring.path.size(); ++i) {
                twice += (ring.path[i] - ring.path[0])
                             .cross(ring.path[(i + 1) % ring.path.size()] - ring.path[0]);
            }
            ring.area = plane->normal.dot(twice) / 2;
        } else {
            double turn = 0;
            for (std::size_t i = 0; i < ring.path.size(); ++i) {
                turn += turn_between(angle_about(surface, ring.path[i]),
                                     angle_about(surface, ring.path[(i + 1) % ring.path.size()]));
            }
            ring.round = static_cast<int>(std::lround(turn / (2 * std::numbers::pi)));
            Eigen::AlignedBox3d box;
            for (const Eigen::Vector3d& p : ring.path) {
                box.extend(p);
            }
            ring.area = box.diagonal().squaredNorm();
        }
        return ring;
    }

    void make_faces() {
        std::vector<std::vector<Ring>> rings(faces_.region.size());
        std::vector<bool> seen(adjacency_.twin.size(), false);
        for (std::uint32_t h = 0; h < adjacency_.twin.size(); ++h) {
            if (is_border(h) && !seen[h]) {
                const auto face = static_cast<std::size_t>(face_at(h));
                rings[face].push_back(ring_from(h, settled_.surfaces[face], seen));
            }
        }
        for (std::size_t f = 0; f < rings.size(); ++f) {
            Face face;
            face.surface = settled_.surfaces[f];
            const std::int32_t region = faces_.region[f];
            face.outward = region < 0 || regions_.all[static_cast<std::size_t>(region)].outward;
            std::stable_sort(rings[f].begin(), rings[f].end(),
                             [](const Ring& a, const Ring& b) { return a.area > b.area; });
            for (const Ring& ring : rings[f]) {
                face.loops.push_back(ring.loop);
            }
            out_.solid.faces.push_back(std::move(face));
        }
        for (std::size_t f = 0; f < rings.size(); ++f) {
            const bool sound = std::holds_alternative<PlaneSurface>(settled_.surfaces[f])
                                   ? is_plane_bounded(rings[f])
                                   : close_round(static_cast<std::int32_t>(f), rings[f]);
            if (!sound && faces_.region[f] >= 0) {
                refused_.insert(faces_.region[f]);
            }
        }
        place_free_vertices();
    }

    /// One outline, the others holes.
    static bool is_plane_bounded(const std::vector<Ring>& rings) {
        return !rings.empty() && rings[0].area > 0 &&
               std::all_of(rings.begin() + 1, rings.end(),
                           [](const Ring& ring) { return ring.area < 0; });
    }

    /// Does a boundary go round the tube of a torus?
    [[nodiscard]] bool winds_round_tube(std::int32_t face, const std::vector<Ring>& rings) const {
        const Surface& surface = settled_.surfaces[static_cast<std::size_t>(face)];
        const auto* torus = std::get_if<TorusSurface>(&surface);
        return torus != nullptr && std::any_of(rings.begin(), rings.end(), [&](const Ring& ring) {
                   double turn = 0;
                   for (std::size_t i = 0; i < ring.path.size(); ++i) {
                       turn +=
                           turn_between(tube_angle(*torus, ring.path[i]),
                                        tube_angle(*torus, ring.path[(i + 1) % ring.path.size()]));
                   }
                   return std::abs(turn) > std::numbers::pi;
               });
    }

    bool close_round(std::int32_t face, const std::vector<Ring>& rings) {
        std::vector<int> round;
        std::vector<std::vector<Eigen::Vector3d>> paths;
        int rims = 0;
        int sum = 0;
        for (const Ring& ring : rings) {
            round.push_back(ring.round);
            paths.push_back(ring.path);
            rims += std::abs(ring.round);
            sum += ring.round;
        }
        if (winds_round_tube(face, rings)) {
            return false;
        }
        if (rims == 0) {
            return !rings.empty();
        }
        return rims == 2 ? sum == 0 && add_seam(out_.solid, face, paths, round)
                         : rims == 1 && add_apex(out_.solid, face, paths, round);
    }

    /// A closed edge that no seam has given a vertex gets one where its parameter begins.
    void place_free_vertices() {
        for (Edge& edge : out_.solid.edges) {
            if (edge.from < 0) {
                edge.from = edge.to = static_cast<std::int32_t>(out_.solid.vertices.size());
                out_.solid.vertices.push_back(point_at(edge.curve, edge.t0));
            }
        }
    }

    /// The shells by their triangles.
    struct Shells {
        std::vector<std::int32_t> of_triangle;
        std::vector<std::int32_t> of_face;
        std::vector<double> volume;
        std::vector<std::uint32_t> first;  ///< triangle of each
    };

    void make_shells() {
        Shells shells;
        shells.of_triangle.assign(mesh_.triangles.size(), -1);
        shells.of_face.assign(faces_.region.size(), -1);
        for (std::uint32_t seed = 0; seed < mesh_.triangles.size(); ++seed) {
            if (shells.of_triangle[seed] < 0) {
                flood_shell(seed, shells);
            }
        }
        nest_cavities(shells);
    }

    /// The shell of all triangles that are connected with this one.
    void flood_shell(std::uint32_t seed, Shells& shells) {
        const auto shell = static_cast<std::int32_t>(out_.solid.shells.size());
        std::vector<std::int32_t>& faces = out_.solid.shells.emplace_back();
        double volume = 0;
        std::vector<std::uint32_t> found{seed};
        shells.of_triangle[seed] = shell;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const std::uint32_t t = found[i];
            const mesh::Triangle& c = mesh_.triangles[t];
            volume += mesh_.points[c[0]].dot(mesh_.points[c[1]].cross(mesh_.points[c[2]])) / 6;
            auto& owner = shells.of_face[static_cast<std::size_t>(faces_.of[t])];
            if (owner < 0) {
                owner = shell;
                faces.push_back(faces_.of[t]);
            }
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t other = adjacency_.twin[3 * t + k] / 3;
                if (shells.of_triangle[other] < 0) {
                    shells.of_triangle[other] = shell;
                    found.push_back(other);
                }
            }
        }
        std::sort(faces.begin(), faces.end());
        shells.volume.push_back(volume);
        shells.first.push_back(seed);
    }

    /// A shell turned inside out is a cavity of the smallest shell that winds round it.
    void nest_cavities(const Shells& shells) {
        const std::vector<double>& volume = shells.volume;
        out_.solid.cavity_of.assign(volume.size(), -1);
        for (std::size_t inner = 0; inner < volume.size(); ++inner) {
            double smallest = INFINITY;
            for (std::size_t outer = 0; volume[inner] < 0 && outer < volume.size(); ++outer) {
                if (volume[outer] > 0 && volume[outer] < smallest &&
                    winds_round(static_cast<std::int32_t>(outer), shells.of_triangle,
                                mesh_.points[mesh_.triangles[shells.first[inner]][0]])) {
                    smallest = volume[outer];
                    out_.solid.cavity_of[inner] = static_cast<std::int32_t>(outer);
                }
            }
        }
    }

    /// By the solid angle of the shell's triangles (van Oosterom and Strackee 1983).
    [[nodiscard]] bool winds_round(std::int32_t shell, const std::vector<std::int32_t>& of_triangle,
                                   const Eigen::Vector3d& p) const {
        double angle = 0;
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (of_triangle[t] != shell) {
                continue;
            }
            const mesh::Triangle& c = mesh_.triangles[t];
            const Eigen::Vector3d a = mesh_.points[c[0]] - p;
            const Eigen::Vector3d b = mesh_.points[c[1]] - p;
            const Eigen::Vector3d d = mesh_.points[c[2]] - p;
            angle += 2 * std::atan2(a.dot(b.cross(d)),
                                    a.norm() * b.norm() * d.norm() + a.dot(b) * d.norm() +
                                        b.dot(d) * a.norm() + d.dot(a) * b.norm());
        }
        return std::abs(angle) > 2 * std::numbers::pi;
    }

    const mesh::TriMesh& mesh_;
    const Adjacency& adjacency_;
    const Regions& regions_;
    const FaceMap& faces_;
    const Settled& settled_;
    Bounded out_;
    double off_mm_ = 0;  ///< left between an edge and its surfaces
    std::set<std::int32_t> refused_;
    std::vector<std::int32_t> vertex_of_;
    std::vector<EdgeUse> use_of_;
};

}  // namespace

Bounded bound(const mesh::TriMesh& mesh, const Adjacency& adjacency, const Regions& regions,
              const FaceMap& faces, const Settled& settled) {
    return Walker(mesh, adjacency, regions, faces, settled).walk();
}

}  // namespace decomp::solid
