// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/medial.h"

#include "cam/polygon/boolean.h"

#include <boost/polygon/segment_data.hpp>
#include <boost/polygon/voronoi.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;
using polygon::Paths;
using polygon::Point;

using GridPoint = boost::polygon::point_data<std::int32_t>;
using GridSegment = boost::polygon::segment_data<std::int32_t>;
using Diagram = boost::polygon::voronoi_diagram<double>;
using Edge = Diagram::edge_type;
using Cell = Diagram::cell_type;
using Vertex = Diagram::vertex_type;

constexpr double kOutlineToleranceMm = 0.01;
constexpr double kSampleMm = 0.2;  // distance of samples on curved edges
/// Width gained per length along a branch into a corner of angle 2 a is 2 sin a: corners blunter
/// than 60 degrees are left to the round end of the bead.
constexpr double kSteepestBranch = 1.0;
constexpr double kMmPerNm = 1e-6;
constexpr std::size_t kNone = ~std::size_t{0};

/// An edge of the axis between two vertices of the diagram.
struct AxisEdge {
    std::array<std::size_t, 2> ends{};
    MedialLine line;  ///< from ends[0] to ends[1]
};

class MedialAxis {
  public:
    MedialAxis(const Paths& region, double least_width_mm) : least_width_mm_(least_width_mm) {
        const polygon::Box box = polygon::bounds(region);
        origin_ = {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2};
        for (const auto& loop : region) {
            for (std::size_t i = 0; i < loop.size(); ++i) {
                segments_.emplace_back(grid(loop[i]), grid(loop[(i + 1) % loop.size()]));
            }
        }
        boost::polygon::construct_voronoi(segments_.begin(), segments_.end(), &diagram_);
    }

    std::vector<MedialLine> lines() {
        collect_edges();
        drop_short_branches();
        return chains();
    }

  private:
    [[nodiscard]] GridPoint grid(const Point& p) const {
        return {static_cast<std::int32_t>(p.x - origin_.x),
                static_cast<std::int32_t>(p.y - origin_.y)};
    }

    static Vector2d local(const GridPoint& p) {
        return {static_cast<double>(p.x()), static_cast<double>(p.y())};
    }

    static Vector2d local(const Vertex& v) { return {v.x(), v.y()}; }

    [[nodiscard]] MedialPoint medial(const Vector2d& local_nm, double radius_nm) const {
        const Vector2d origin = polygon::to_mm(origin_);
        return {origin + local_nm * kMmPerNm, 2 * kMmPerNm * radius_nm};
    }

    /// The site of a cell that stands for a segment's end point.
    [[nodiscard]] Vector2d site_point(const Cell& cell) const {
        const GridSegment& s = segments_[cell.source_index()];
        return local(cell.source_category() == boost::polygon::SOURCE_CATEGORY_SEGMENT_START_POINT
                         ? s.low()
                         : s.high());
    }

    [[nodiscard]] double distance(const Vector2d& p, const Cell& cell) const {
        if (cell.contains_point()) {
            return (p - site_point(cell)).norm();
        }
        const GridSegment& s = segments_[cell.source_index()];
        const Vector2d a = local(s.low());
        const Vector2d along = local(s.high()) - a;
        return std::abs(along.x() * (p - a).y() - along.y() * (p - a).x()) / along.norm();
    }

    /// Samples of an edge; a parabola where one site is a point and the other a segment.
    [[nodiscard]] MedialLine sampled(const Edge& edge) const {
        const Vector2d from = local(*edge.vertex0());
        const Vector2d to = local(*edge.vertex1());
        const Cell& cell = *edge.cell();
        MedialLine line{medial(from, distance(from, cell))};
        const Cell& point_cell = cell.contains_point() ? cell : *edge.twin()->cell();
        const Cell& line_cell = cell.contains_point() ? *edge.twin()->cell() : cell;
        if (edge.is_curved() && point_cell.contains_point() && line_cell.contains_segment()) {
            const Vector2d focus = site_point(point_cell);
            const GridSegment& s = segments_[line_cell.source_index()];
            const Vector2d base = local(s.low());
            const Vector2d along = (local(s.high()) - base).normalized();
            const double tf = (focus - base).dot(along);
            const Vector2d up = (focus - base) - tf * along;
            const double height = up.norm();
            const double t0 = (from - base).dot(along);
            const double t1 = (to - base).dot(along);
            const int count = static_cast<int>(std::abs(t1 - t0) * kMmPerNm / kSampleMm);
            for (int i = 1; i <= count && height > 0; ++i) {
                const double t = t0 + (t1 - t0) * i / (count + 1);
                const double y = ((t - tf) * (t - tf) + height * height) / (2 * height);
                line.push_back(medial(base + t * along + (y / height) * up, y));
            }
        }
        line.push_back(medial(to, distance(to, cell)));
        return line;
    }

    /// Edges inside the region, wide enough, and not running up into a blunt corner.
    void collect_edges() {
        for (const Edge& edge : diagram_.edges()) {
            if (!edge.is_primary() || !edge.is_finite() || &edge > edge.twin() || !inside(edge)) {
                continue;
            }
            AxisEdge axis{{index_of(edge.vertex0()), index_of(edge.vertex1())}, sampled(edge)};
            const MedialPoint& a = axis.line.front();
            const MedialPoint& b = axis.line.back();
            const double length = (b.at_mm - a.at_mm).norm();
            if (length > 0 && std::abs(b.width_mm - a.width_mm) <= kSteepestBranch * length &&
                clip_to_least_width(axis)) {
                edges_.push_back(std::move(axis));
            }
        }
    }

    /// Shortens an edge whose one end is too narrow; false when all of it is.
    [[nodiscard]] bool clip_to_least_width(AxisEdge& axis) const {
        MedialLine& line = axis.line;
        if (line.front().width_mm < least_width_mm_ && line.back().width_mm < least_width_mm_) {
            return false;
        }
        const bool flip = line.front().width_mm < least_width_mm_;
        if (flip) {
            std::reverse(line.begin(), line.end());
        }
        while (line.size() > 2 && line[line.size() - 2].width_mm < least_width_mm_) {
            line.pop_back();
        }
        if (line.back().width_mm < least_width_mm_) {
            const MedialPoint& a = line[line.size() - 2];
            MedialPoint& b = line.back();
            const double t = (a.width_mm - least_width_mm_) / (a.width_mm - b.width_mm);
            b = {a.at_mm + t * (b.at_mm - a.at_mm), least_width_mm_};
        }
        if (flip) {
            std::reverse(line.begin(), line.end());
        }
        return true;
    }

    [[nodiscard]] std::size_t index_of(const Vertex* vertex) const {
        return static_cast<std::size_t>(vertex - diagram_.vertices().data());
    }

    /// Whether an edge lies in the region: loops have the region on their left, so a point is
    /// inside when it is on the left of the nearest segment, which is the cell's own.
    [[nodiscard]] bool inside(const Edge& edge) const {
        const Vector2d middle = (local(*edge.vertex0()) + local(*edge.vertex1())) / 2;
        for (const Edge* side : {&edge, edge.twin()}) {
            const Cell& cell = *side->cell();
            if (cell.contains_segment()) {
                const GridSegment& s = segments_[cell.source_index()];
                const Vector2d a = local(s.low());
                const Vector2d along = local(s.high()) - a;
                const Vector2d to = middle - a;
                return along.x() * to.y() - along.y() * to.x() > 0;
            }
        }
        // Between two vertices: only reflex corners have cells inside the region, so ask the
        // outline.
        std::size_t crossings = 0;
        for (const GridSegment& s : segments_) {
            const Vector2d a = local(s.low());
            const Vector2d b = local(s.high());
            if ((a.y() > middle.y()) != (b.y() > middle.y()) &&
                middle.x() < a.x() + (b.x() - a.x()) * (middle.y() - a.y()) / (b.y() - a.y())) {
                ++crossings;
            }
        }
        return crossings % 2 != 0;
    }

    void count_degrees() {
        at_vertex_.assign(diagram_.num_vertices(), {});
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            for (const std::size_t v : edges_[e].ends) {
                at_vertex_[v].push_back(e);
            }
        }
    }

    /// Branches shorter than half the strip's width at the junction lie within the other beads.
    void drop_short_branches() {
        count_degrees();
        std::vector<char> dropped(edges_.size(), 0);
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const auto& ends = edges_[e].ends;
            const bool leaf0 = at_vertex_[ends[0]].size() == 1;
            const bool leaf1 = at_vertex_[ends[1]].size() == 1;
            const std::size_t joint = leaf0 ? ends[1] : ends[0];
            const MedialLine& line = edges_[e].line;
            const double width = (leaf0 ? line.back() : line.front()).width_mm;
            dropped[e] =
                static_cast<char>(leaf0 != leaf1 && at_vertex_[joint].size() > 2 &&
                                  (line.back().at_mm - line.front().at_mm).norm() < width / 2);
        }
        std::vector<AxisEdge> kept;
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            if (dropped[e] == 0) {
                kept.push_back(std::move(edges_[e]));
            }
        }
        edges_ = std::move(kept);
        count_degrees();
    }

    /// The unused edge that leads on at a vertex of two edges.
    [[nodiscard]] std::size_t next_edge(std::size_t vertex, const std::vector<char>& used) const {
        const auto& edges = at_vertex_[vertex];
        if (edges.size() == 2) {
            for (const std::size_t e : edges) {
                if (used[e] == 0) {
                    return e;
                }
            }
        }
        return kNone;
    }

    [[nodiscard]] MedialLine walk(std::size_t vertex, std::size_t edge,
                                  std::vector<char>& used) const {
        MedialLine out;
        while (edge != kNone) {
            used[edge] = 1;
            const AxisEdge& axis = edges_[edge];
            MedialLine line = axis.line;
            if (axis.ends[0] != vertex) {
                std::reverse(line.begin(), line.end());
            }
            out.insert(out.end(), line.begin() + (out.empty() ? 0 : 1), line.end());
            vertex = axis.ends[axis.ends[0] == vertex ? 1 : 0];
            edge = next_edge(vertex, used);
        }
        return out;
    }

    [[nodiscard]] std::vector<MedialLine> chains() const {
        std::vector<MedialLine> out;
        std::vector<char> used(edges_.size(), 0);
        const auto start = [&](std::size_t vertex, std::size_t edge) {
            if (used[edge] == 0) {
                out.push_back(walk(vertex, edge, used));
            }
        };
        for (std::size_t v = 0; v < at_vertex_.size(); ++v) {
            for (const std::size_t e : at_vertex_[v]) {
                if (at_vertex_[v].size() != 2) {
                    start(v, e);
                }
            }
        }
        // What is left are rings.
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            start(edges_[e].ends[0], e);
        }
        return out;
    }

    double least_width_mm_;
    Point origin_;
    std::vector<GridSegment> segments_;
    Diagram diagram_;
    std::vector<AxisEdge> edges_;
    std::vector<std::vector<std::size_t>> at_vertex_;
};

double length_mm(const MedialPoint& a, const MedialPoint& b) { return (b.at_mm - a.at_mm).norm(); }

}  // namespace

std::vector<MedialLine> medial_lines(const Paths& region, double least_width_mm) {
    std::vector<MedialLine> out;
    // Simplifying may make an outline cross itself; the union heals that.
    const Paths clean = polygon::region_of(polygon::simplified(region, kOutlineToleranceMm));
    for (const polygon::Island& island : polygon::islands(clean)) {
        auto lines = MedialAxis(island.loops(), least_width_mm).lines();
        std::move(lines.begin(), lines.end(), std::back_inserter(out));
    }
    return out;
}

std::vector<MedialPiece> pieces_of_one_width(const MedialLine& line, double step_mm) {
    std::vector<MedialPiece> out;
    MedialPiece piece;
    double length = 0;
    double area = 0;
    double low = 0;
    double high = 0;
    const auto finish = [&] {
        if (length > 0) {
            piece.width_mm = area / length;
            out.push_back(std::move(piece));
        }
        piece = {};
        length = area = 0;
    };
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        // Long tapering stretches are cut up so that each part keeps to the step.
        const MedialPoint& a = line[i];
        const MedialPoint& b = line[i + 1];
        const int parts = 1 + static_cast<int>(std::abs(b.width_mm - a.width_mm) / step_mm);
        for (int k = 0; k < parts; ++k) {
            const auto at = [&](int j) {
                const double t = static_cast<double>(j) / parts;
                return MedialPoint{a.at_mm + t * (b.at_mm - a.at_mm),
                                   a.width_mm + t * (b.width_mm - a.width_mm)};
            };
            const MedialPoint from = at(k);
            const MedialPoint to = at(k + 1);
            const double width = (from.width_mm + to.width_mm) / 2;
            const auto [narrow, wide] = std::minmax(from.width_mm, to.width_mm);
            if (!piece.points.empty() && std::max(high, wide) - std::min(low, narrow) > step_mm) {
                finish();
            }
            if (piece.points.empty()) {
                piece.points.push_back(from.at_mm);
                low = narrow;
                high = wide;
            }
            piece.points.push_back(to.at_mm);
            low = std::min(low, narrow);
            high = std::max(high, wide);
            length += length_mm(from, to);
            area += width * length_mm(from, to);
        }
    }
    finish();
    return out;
}

}  // namespace cam::fdm
