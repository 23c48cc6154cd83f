// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sections/trial_cut.h"

#include "decomp/mesh/measure.h"
#include "decomp/sections/profile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace decomp::sections {

namespace {

constexpr double kSquareEnough = 0.5;  // |sine| of the angle off square: 30 degrees
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Union-find with the smallest index as root.
class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }

    void unite(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

/// A point where the plane cuts an edge of the mesh.
struct CutEdge {
    std::uint32_t below, above;  // vertices
};

/// A closed curve of the section.
struct Loop {
    std::vector<std::uint32_t> cuts;  // in order, material on the left seen from above
    double area = 0;                  // signed
    double length = 0;
    double feather = 0;           // length weighted by how flat the surface leaves the plane
    std::uint32_t below = kNone;  // a vertex of the surface on either side
    std::uint32_t above = kNone;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Vector2d sample =
        Eigen::Vector2d::Zero();  // a point on it, on the input surface if it has one there
};

class TrialCut {
  public:
    TrialCut(const part::Part& part, const part::Plane& plane, std::int32_t plane_index)
        : part_(part),
          mesh_(part.mesh),
          plane_index_(plane_index),
          direction_(plane.normal.normalized()),
          basis_(plane_basis(direction_)),
          sets_(part.mesh.points.size()),
          heights_(part.mesh.points.size()) {
        const double offset = plane.offset_mm / plane.normal.norm();
        for (std::size_t i = 0; i < heights_.size(); ++i) {
            heights_[i] = direction_.dot(mesh_.points[i]) - offset;
        }
    }

    std::vector<TrialPiece> pieces() {
        join_surfaces();
        find_cut_edges();
        if (cut_edges_.empty()) {
            TrialPiece whole;
            whole.above = !mesh_.triangles.empty() && is_above(mesh_.triangles[0][0]);
            whole.volume_mm3 = mesh::volume_mm3(mesh_);
            whole.bridge_mm = std::numeric_limits<double>::infinity();
            whole.part = part_;
            return {whole};
        }
        trace_loops();
        join_nested_loops();
        join_loose_shells();
        return collect();
    }

  private:
    [[nodiscard]] bool is_above(std::uint32_t v) const { return heights_[v] >= 0; }

    void join_surfaces() {
        for (const mesh::Triangle& t : mesh_.triangles) {
            for (std::size_t i = 0; i < 3; ++i) {
                if (is_above(t.at(i)) == is_above(t.at((i + 1) % 3))) {
                    sets_.unite(t.at(i), t.at((i + 1) % 3));
                }
            }
        }
    }

    void find_cut_edges() {
        for (const mesh::Triangle& t : mesh_.triangles) {
            for (std::size_t i = 0; i < 3; ++i) {
                // Every cut edge is gone down exactly once on a closed surface.
                if (is_above(t.at(i)) && !is_above(t.at((i + 1) % 3))) {
                    cut_edges_.push_back({t.at((i + 1) % 3), t.at(i)});
                }
            }
        }
        std::sort(cut_edges_.begin(), cut_edges_.end(), before);
        cut_edges_.erase(std::unique(cut_edges_.begin(), cut_edges_.end(),
                                     [](const CutEdge& a, const CutEdge& b) {
                                         return !before(a, b) && !before(b, a);
                                     }),
                         cut_edges_.end());
        for (const CutEdge& cut : cut_edges_) {
            const double s = heights_[cut.below] / (heights_[cut.below] - heights_[cut.above]);
            const Eigen::Vector3d& a = mesh_.points[cut.below];
            points_.emplace_back(a + s * (mesh_.points[cut.above] - a));
        }
    }

    static bool before(const CutEdge& a, const CutEdge& b) {
        return a.below != b.below ? a.below < b.below : a.above < b.above;
    }

    [[nodiscard]] std::uint32_t cut_of(std::uint32_t a, std::uint32_t b) const {
        const CutEdge edge = is_above(a) ? CutEdge{b, a} : CutEdge{a, b};
        const auto found = std::lower_bound(cut_edges_.begin(), cut_edges_.end(), edge, before);
        return static_cast<std::uint32_t>(found - cut_edges_.begin());
    }

    [[nodiscard]] Eigen::Vector2d flat(const Eigen::Vector3d& p) const {
        return {basis_[0].dot(p), basis_[1].dot(p)};
    }

    /// 0 where a facet meets the plane squarely, 1 where it lies in it.
    [[nodiscard]] double flatness_of(std::size_t triangle) const {
        const Eigen::Vector3d normal = mesh::double_area_normal(mesh_, triangle);
        const double length = normal.norm();
        const double tangency = length > 0 ? std::abs(normal.dot(direction_)) / length : 0;
        const double excess = std::max(0.0, (tangency - kSquareEnough) / (1 - kSquareEnough));
        return excess * excess;
    }

    void trace_loops() {
        std::vector<std::uint32_t> next(cut_edges_.size(), kNone);
        std::vector<bool> on_input(cut_edges_.size(), false);
        std::vector<double> flatness(cut_edges_.size(), 0.0);
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
            const mesh::Triangle& t = mesh_.triangles[i];
            std::uint32_t from = kNone;
            std::uint32_t to = kNone;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t.at(k);
                const std::uint32_t b = t.at((k + 1) % 3);
                if (is_above(a) != is_above(b)) {
                    (is_above(a) ? from : to) = cut_of(a, b);
                }
            }
            if (from != kNone && to != kNone) {
                next[from] = to;
                on_input[from] = !part_.sources[i].is_cut();
                flatness[from] = flatness_of(i);
            }
        }
        std::vector<bool> seen(cut_edges_.size(), false);
        for (std::uint32_t first = 0; first < next.size(); ++first) {
            Loop loop;
            for (std::uint32_t cut = first; cut != kNone && !seen[cut]; cut = next[cut]) {
                seen[cut] = true;
                loop.cuts.push_back(cut);
            }
            if (!loop.cuts.empty()) {
                measure_loop(loop, on_input, flatness);
                loops_.push_back(std::move(loop));
            }
        }
    }

    void measure_loop(Loop& loop, const std::vector<bool>& on_input,
                      const std::vector<double>& flatness) {
        loop.below = cut_edges_[loop.cuts.front()].below;
        loop.above = cut_edges_[loop.cuts.front()].above;
        const Eigen::Vector2d origin = flat(points_[loop.cuts.front()]);
        bool sampled = false;
        for (std::size_t i = 0; i < loop.cuts.size(); ++i) {
            const std::uint32_t here = loop.cuts[i];
            const std::uint32_t there = loop.cuts[(i + 1) % loop.cuts.size()];
            const Eigen::Vector2d a = flat(points_[here]) - origin;
            const Eigen::Vector2d b = flat(points_[there]) - origin;
            loop.length += (b - a).norm();
            loop.feather += (b - a).norm() * flatness[here];
            loop.area += (a.x() * b.y() - a.y() * b.x()) / 2;
            loop.centre += points_[here] / static_cast<double>(loop.cuts.size());
            if (!sampled && (on_input[here] || i + 1 == loop.cuts.size())) {
                loop.sample = origin + (a + b) / 2;
                sampled = true;
            }
        }
    }

    [[nodiscard]] bool contains(const Loop& loop, const Eigen::Vector2d& point) const {
        bool inside = false;
        for (std::size_t i = 0; i < loop.cuts.size(); ++i) {
            const Eigen::Vector2d a = flat(points_[loop.cuts[i]]);
            const Eigen::Vector2d b = flat(points_[loop.cuts[(i + 1) % loop.cuts.size()]]);
            if ((a.y() > point.y()) != (b.y() > point.y()) &&
                point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
                inside = !inside;
            }
        }
        return inside;
    }

    /// The wall of a cavity that the plane opens belongs to the piece around it.
    void join_nested_loops() {
        for (const Loop& hole : loops_) {
            if (hole.area >= 0) {
                continue;
            }
            const Loop* around = nullptr;
            for (const Loop& outline : loops_) {
                if (outline.area > 0 && outline.area >= -hole.area &&
                    (around == nullptr || outline.area < around->area) &&
                    contains(outline, hole.sample)) {
                    around = &outline;
                }
            }
            if (around != nullptr) {
                sets_.unite(hole.below, around->below);
                sets_.unite(hole.above, around->above);
            }
        }
    }

    /// Shells that the plane does not cut are walls of cavities: they go to the smallest piece on
    /// their side whose bounds hold theirs.
    void join_loose_shells() {
        std::vector<bool> touched(heights_.size(), false);
        for (const Loop& loop : loops_) {
            touched[sets_.root(loop.below)] = true;
            touched[sets_.root(loop.above)] = true;
        }
        std::vector<std::uint32_t> slot(heights_.size(), kNone);
        std::vector<std::uint32_t> roots;
        std::vector<Eigen::AlignedBox3d> boxes;
        for (const mesh::Triangle& t : mesh_.triangles) {
            for (const std::uint32_t v : t) {
                const std::uint32_t root = sets_.root(v);
                if (slot[root] == kNone) {
                    slot[root] = static_cast<std::uint32_t>(roots.size());
                    roots.push_back(root);
                    boxes.emplace_back();
                }
                boxes[slot[root]].extend(mesh_.points[v]);
            }
        }
        for (std::size_t i = 0; i < roots.size(); ++i) {
            if (touched[roots[i]]) {
                continue;
            }
            std::size_t home = roots.size();
            for (std::size_t k = 0; k < roots.size(); ++k) {
                if (touched[roots[k]] && is_above(roots[k]) == is_above(roots[i]) &&
                    boxes[k].contains(boxes[i]) &&
                    (home == roots.size() || boxes[k].volume() < boxes[home].volume())) {
                    home = k;
                }
            }
            if (home < roots.size()) {
                sets_.unite(roots[i], roots[home]);
            }
        }
    }

    /// A piece under construction: renumbers points as they are met.
    struct Builder {
        TrialPiece piece;
        double six_volumes = 0;
        double rim = 0;
    };

    std::uint32_t point_in(Builder& builder, std::size_t global, const Eigen::Vector3d& point) {
        // A point of the mesh lies on one side only, hence in one piece; a cut point has a copy for
        // either side.
        if (local_[global] == kNone) {
            local_[global] = static_cast<std::uint32_t>(builder.piece.part.mesh.points.size());
            builder.piece.part.mesh.points.push_back(point);
        }
        return local_[global];
    }

    /// Corner of a clipped triangle: a point of the mesh, or a cut point.
    struct Corner {
        bool is_cut;
        std::uint32_t index;
    };

    void add_polygon(Builder& builder, bool above, const std::vector<Corner>& corners,
                     const part::FacetSource& source) {
        std::array<std::uint32_t, 4> ids{};
        std::array<double, 4> heights{};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Corner& c = corners[i];
            const std::size_t copies = above ? points_.size() : 0;
            ids.at(i) = c.is_cut ? point_in(builder, mesh_.points.size() + copies + c.index,
                                            points_[c.index])
                                 : point_in(builder, c.index, mesh_.points[c.index]);
            heights.at(i) = c.is_cut ? 0 : heights_[c.index];
        }
        for (std::size_t i = 2; i < corners.size(); ++i) {
            part::Part& part = builder.piece.part;
            part.mesh.triangles.push_back({ids[0], ids.at(i - 1), ids.at(i)});
            part.sources.push_back(source);
            // Flux of (height above the plane) x normal: the caps lie at height 0 and add nothing.
            builder.six_volumes +=
                mesh::double_area_normal(part.mesh, part.mesh.triangles.size() - 1)
                    .dot(direction_) *
                (heights[0] + heights.at(i - 1) + heights.at(i));
        }
    }

    void add_clipped(std::size_t triangle, bool above, std::vector<Builder>& builders) {
        const mesh::Triangle& t = mesh_.triangles[triangle];
        std::vector<Corner> corners;
        std::uint32_t vertex = kNone;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t.at(i);
            const std::uint32_t b = t.at((i + 1) % 3);
            if (is_above(a) == above) {
                corners.push_back({false, a});
                vertex = a;
            }
            if (is_above(a) != is_above(b)) {
                corners.push_back({true, cut_of(a, b)});
            }
        }
        if (vertex != kNone) {
            add_polygon(builders[builder_of(vertex, builders)], above, corners,
                        part_.sources[triangle]);
        }
    }

    std::uint32_t builder_of(std::uint32_t vertex, std::vector<Builder>& builders) {
        const std::uint32_t root = sets_.root(vertex);
        if (builder_[root] == kNone) {
            builder_[root] = static_cast<std::uint32_t>(builders.size());
            builders.emplace_back();
            builders.back().piece.above = is_above(vertex);
        }
        return builder_[root];
    }

    void add_cap(const Loop& loop, bool above, std::vector<Builder>& builders) {
        Builder& builder = builders[builder_of(above ? loop.above : loop.below, builders)];
        part::Part& part = builder.piece.part;
        const auto centre = static_cast<std::uint32_t>(part.mesh.points.size());
        part.mesh.points.push_back(loop.centre);
        const std::size_t copies = mesh_.points.size() + (above ? points_.size() : 0);
        for (std::size_t i = 0; i < loop.cuts.size(); ++i) {
            const std::uint32_t a = local_[copies + loop.cuts[i]];
            const std::uint32_t b = local_[copies + loop.cuts[(i + 1) % loop.cuts.size()]];
            // The cap of the lower piece faces up: counter-clockwise like the loop.
            part.mesh.triangles.push_back(above ? mesh::Triangle{centre, b, a}
                                                : mesh::Triangle{centre, a, b});
            part.sources.push_back({plane_index_, above ? 0 : 1});
        }
        builder.piece.interface_mm2 += loop.area;
        builder.rim += loop.length;
        builder.piece.feather += loop.feather;
    }

    std::vector<TrialPiece> collect() {
        local_.assign(mesh_.points.size() + 2 * points_.size(), kNone);
        builder_.assign(mesh_.points.size(), kNone);
        std::vector<Builder> builders;
        for (const bool above : {false, true}) {
            for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
                add_clipped(i, above, builders);
            }
            for (const Loop& loop : loops_) {
                add_cap(loop, above, builders);
            }
        }
        std::vector<TrialPiece> out;
        for (Builder& builder : builders) {
            TrialPiece& piece = builder.piece;
            piece.volume_mm3 = builder.six_volumes / 6;
            piece.bridge_mm = piece.interface_mm2 > 0 ? piece.volume_mm3 / piece.interface_mm2
                                                      : std::numeric_limits<double>::infinity();
            piece.feather = builder.rim > 0 ? piece.feather / builder.rim : 0;
            out.push_back(std::move(piece));
        }
        return out;
    }

    const part::Part& part_;
    const mesh::TriMesh& mesh_;
    std::int32_t plane_index_;
    Eigen::Vector3d direction_;
    std::array<Eigen::Vector3d, 2> basis_;
    Sets sets_;
    std::vector<double> heights_;
    std::vector<CutEdge> cut_edges_;
    std::vector<Eigen::Vector3d> points_;
    std::vector<Loop> loops_;
    std::vector<std::uint32_t> local_;
    std::vector<std::uint32_t> builder_;
};

}  // namespace

std::vector<TrialPiece> trial_cut(const part::Part& part, const part::Plane& plane,
                                  std::int32_t plane_index) {
    return TrialCut(part, plane, plane_index).pieces();
}

}  // namespace decomp::sections
