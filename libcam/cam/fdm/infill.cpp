// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/infill.h"

#include "cam/fdm/disjoint_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;
using polygon::Paths;

constexpr std::size_t kNone = ~std::size_t{0};

/// Where a scan line meets the boundary. Crossings 2 i and 2 i + 1 of a row, sorted along it, are a
/// line's ends.
struct Crossing {
    long row = 0;      ///< number of the scan line
    double along = 0;  ///< position on it
    std::size_t loop = 0;
    std::size_t edge = 0;      ///< from vertex `edge` to the next
    double on_edge = 0;        ///< 0..1
    std::size_t partner = 0;   ///< other end of its line
    std::size_t link = kNone;  ///< crossing to which the boundary leads on
    bool link_forward = true;  ///< along the loop's own direction
};

struct Link {
    std::size_t from = 0;  ///< crossing; the way runs along the loop's direction
    std::size_t to = 0;
    double length_mm = 0;
};

class LineFill {
  public:
    LineFill(const Paths& region, const FillPattern& pattern) : pattern_(pattern) {
        for (const auto& path : region) {
            auto& loop = loops_.emplace_back();
            loop.reserve(path.size());
            for (const auto& p : path) {
                loop.push_back(polygon::to_mm(p));
            }
        }
    }

    std::vector<Line> lines() {
        find_crossings();
        pair_crossings();
        link_ends();
        return chains();
    }

    std::vector<Line> lines_in_order() {
        find_crossings();
        pair_crossings();
        find_cells();
        return sweep();
    }

  private:
    /// A run of lines one above the other, each with the next as its only neighbour.
    struct Cell {
        std::vector<std::size_t> lines;  ///< bottom up, as positions of their left ends in sorted_
        std::size_t below = 0;           ///< cells that must be printed before
        std::vector<std::size_t> above;
    };

    /// In the order of the boundary: loop by loop, edge by edge, along each edge.
    void find_crossings() {
        const double angle = pattern_.angle.radians();
        const Vector2d along(std::cos(angle), std::sin(angle));
        const Vector2d across(-along.y(), along.x());
        for (std::size_t l = 0; l < loops_.size(); ++l) {
            const auto& loop = loops_[l];
            for (std::size_t e = 0; e < loop.size(); ++e) {
                const Vector2d& a = loop[e];
                const Vector2d& b = loop[(e + 1) % loop.size()];
                const double va = a.dot(across) / pattern_.spacing_mm;
                const double vb = b.dot(across) / pattern_.spacing_mm;
                // Half-open: a row through a vertex belongs to the edge above it.
                const auto low = static_cast<long>(std::ceil(std::min(va, vb)));
                const auto high = static_cast<long>(std::ceil(std::max(va, vb))) - 1;
                for (long i = low; i <= high; ++i) {
                    const long row = va < vb ? i : low + high - i;
                    const double t = (static_cast<double>(row) - va) / (vb - va);
                    const Vector2d p = a + t * (b - a);
                    crossings_.push_back({row, p.dot(along), l, e, t});
                }
            }
        }
    }

    void pair_crossings() {
        sorted_.resize(crossings_.size());
        std::iota(sorted_.begin(), sorted_.end(), std::size_t{0});
        std::sort(sorted_.begin(), sorted_.end(), [this](std::size_t a, std::size_t b) {
            return std::tie(crossings_[a].row, crossings_[a].along, a) <
                   std::tie(crossings_[b].row, crossings_[b].along, b);
        });
        for (std::size_t i = 0; i + 1 < sorted_.size(); i += 2) {
            crossings_[sorted_[i]].partner = sorted_[i + 1];
            crossings_[sorted_[i + 1]].partner = sorted_[i];
        }
    }

    /// Length of the boundary from one crossing to the next one on the same loop; stops counting
    /// beyond the limit.
    [[nodiscard]] double way_mm(const Crossing& from, const Crossing& to) const {
        const auto& loop = loops_[from.loop];
        Vector2d at = point(from);
        double length = 0;
        std::size_t e = from.edge;
        const bool same = from.edge == to.edge && from.on_edge <= to.on_edge;
        while (!same && length <= pattern_.max_link_mm) {
            e = (e + 1) % loop.size();
            length += (loop[e] - at).norm();
            at = loop[e];
            if (e == to.edge) {
                break;
            }
        }
        return length + (point(to) - at).norm();
    }

    [[nodiscard]] std::vector<Link> possible_links() const {
        std::vector<Link> out;
        for (std::size_t begin = 0; begin < crossings_.size();) {
            std::size_t end = begin;
            while (end < crossings_.size() && crossings_[end].loop == crossings_[begin].loop) {
                ++end;
            }
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t j = i + 1 < end ? i + 1 : begin;
                const double length = way_mm(crossings_[i], crossings_[j]);
                if (i != j && std::abs(crossings_[i].row - crossings_[j].row) <= 1 &&
                    length <= pattern_.max_link_mm) {
                    out.push_back({i, j, length});
                }
            }
            begin = end;
        }
        return out;
    }

    /// Takes links in the order of the rows, never closing a ring: sweeping upwards, each pair of
    /// lines is joined at one end, the next pair at the other.
    void link_ends() {
        auto links = possible_links();
        const auto key = [this](const Link& l) {
            return std::tuple(crossings_[l.from].row + crossings_[l.to].row, l.length_mm, l.from);
        };
        std::sort(links.begin(), links.end(),
                  [&](const Link& a, const Link& b) { return key(a) < key(b); });
        DisjointSets chains(crossings_.size());
        for (std::size_t i = 0; i < crossings_.size(); ++i) {
            chains.join(i, crossings_[i].partner);
        }
        for (const Link& l : links) {
            if (crossings_[l.from].link != kNone || crossings_[l.to].link != kNone ||
                !chains.join(l.from, l.to)) {
                continue;
            }
            crossings_[l.from].link = l.to;
            crossings_[l.from].link_forward = true;
            crossings_[l.to].link = l.from;
            crossings_[l.to].link_forward = false;
        }
    }

    [[nodiscard]] Vector2d point(const Crossing& c) const {
        const auto& loop = loops_[c.loop];
        const Vector2d& a = loop[c.edge];
        return a + c.on_edge * (loop[(c.edge + 1) % loop.size()] - a);
    }

    /// Appends the boundary's vertices between a crossing and the one it is linked to.
    void append_link(const Crossing& from, Line& line) const {
        const Crossing& to = crossings_[from.link];
        const auto& loop = loops_[from.loop];
        const Crossing& first = from.link_forward ? from : to;
        const Crossing& last = from.link_forward ? to : from;
        Line between;
        if (first.edge != last.edge || first.on_edge > last.on_edge) {
            std::size_t e = first.edge;
            do {
                e = (e + 1) % loop.size();
                between.push_back(loop[e]);
            } while (e != last.edge);
        }
        if (!from.link_forward) {
            std::reverse(between.begin(), between.end());
        }
        line.insert(line.end(), between.begin(), between.end());
    }

    [[nodiscard]] std::vector<Line> chains() const {
        std::vector<Line> out;
        std::vector<char> used(crossings_.size(), 0);
        for (const std::size_t start : sorted_) {
            if (used[start] != 0 || crossings_[start].link != kNone) {
                continue;
            }
            Line line;
            for (std::size_t i = start;;) {
                const std::size_t other = crossings_[i].partner;
                used[i] = used[other] = 1;
                line.push_back(point(crossings_[i]));
                line.push_back(point(crossings_[other]));
                if (crossings_[other].link == kNone) {
                    break;
                }
                append_link(crossings_[other], line);
                i = crossings_[other].link;
            }
            out.push_back(std::move(line));
        }
        return out;
    }

    // === in order

    [[nodiscard]] long row_of(std::size_t line) const { return crossings_[sorted_[line]].row; }

    [[nodiscard]] double left(std::size_t line) const { return crossings_[sorted_[line]].along; }

    [[nodiscard]] double right(std::size_t line) const {
        return crossings_[sorted_[line + 1]].along;
    }

    /// Lines of the next row that lie beside a line, per line: both lists run along the rows.
    [[nodiscard]] std::vector<std::vector<std::size_t>> neighbours_above() const {
        std::vector<std::vector<std::size_t>> out(sorted_.size() / 2);
        std::size_t upper = 0;
        for (std::size_t line = 0; line + 1 < sorted_.size(); line += 2) {
            const long row = row_of(line);
            while (
                upper + 1 < sorted_.size() &&
                (row_of(upper) <= row || (row_of(upper) == row + 1 && right(upper) < left(line)))) {
                upper += 2;
            }
            for (std::size_t u = upper;
                 u + 1 < sorted_.size() && row_of(u) == row + 1 && left(u) <= right(line); u += 2) {
                out[line / 2].push_back(u);
            }
        }
        return out;
    }

    void find_cells() {
        const auto above = neighbours_above();
        std::vector<std::size_t> count_below(above.size(), 0);
        for (const auto& list : above) {
            for (const std::size_t u : list) {
                ++count_below[u / 2];
            }
        }
        std::vector<std::size_t> cell_of(above.size(), kNone);
        for (std::size_t line = 0; line + 1 < sorted_.size(); line += 2) {
            if (cell_of[line / 2] == kNone) {
                cell_of[line / 2] = cells_.size();
                cells_.emplace_back();
            }
            const std::size_t cell = cell_of[line / 2];
            cells_[cell].lines.push_back(line);
            const auto& up = above[line / 2];
            if (up.size() == 1 && count_below[up.front() / 2] == 1) {
                cell_of[up.front() / 2] = cell;
            }
        }
        for (std::size_t line = 0; line < above.size(); ++line) {
            for (const std::size_t u : above[line]) {
                if (cell_of[u / 2] != cell_of[line]) {
                    cells_[cell_of[line]].above.push_back(cell_of[u / 2]);
                    ++cells_[cell_of[u / 2]].below;
                }
            }
        }
    }

    /// The boundary between the ends on one side of two lines, when it leads from one to the other
    /// on a short way.
    [[nodiscard]] bool link(std::size_t from, std::size_t to) {
        for (const bool forward : {true, false}) {
            const std::size_t first = forward ? from : to;
            const std::size_t last = forward ? to : from;
            const bool next = last == first + 1 && crossings_[first].loop == crossings_[last].loop;
            const bool round = last < first && crossings_[first].loop == crossings_[last].loop &&
                               (last == 0 || crossings_[last - 1].loop != crossings_[last].loop) &&
                               (first + 1 == crossings_.size() ||
                                crossings_[first + 1].loop != crossings_[first].loop);
            if ((next || round) &&
                way_mm(crossings_[first], crossings_[last]) <= pattern_.max_link_mm) {
                crossings_[from].link = to;
                crossings_[from].link_forward = forward;
                return true;
            }
        }
        return false;
    }

    /// The lines of a cell from the bottom up, begun at the end of the first that is nearer.
    void append_cell(const Cell& cell, Vector2d& at, std::vector<Line>& out) {
        std::size_t begin = sorted_[cell.lines.front()];
        std::size_t end = sorted_[cell.lines.front() + 1];
        if ((point(crossings_[end]) - at).squaredNorm() <
            (point(crossings_[begin]) - at).squaredNorm()) {
            std::swap(begin, end);
        }
        out.push_back({point(crossings_[begin]), point(crossings_[end])});
        bool leftwards = end == sorted_[cell.lines.front()];
        for (std::size_t k = 1; k < cell.lines.size(); ++k) {
            begin = sorted_[cell.lines[k] + (leftwards ? 0 : 1)];
            if (link(end, begin)) {
                append_link(crossings_[end], out.back());
            } else {
                out.emplace_back();
            }
            end = crossings_[begin].partner;
            out.back().push_back(point(crossings_[begin]));
            out.back().push_back(point(crossings_[end]));
            leftwards = !leftwards;
        }
        at = point(crossings_[end]);
    }

    /// Of the cells all of whose lower neighbours are printed, the nearest first.
    [[nodiscard]] std::vector<Line> sweep() {
        std::vector<Line> out;
        std::vector<std::size_t> ready;
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            if (cells_[c].below == 0) {
                ready.push_back(c);
            }
        }
        Vector2d at = cells_.empty() ? Vector2d(0, 0) : point(crossings_[sorted_.front()]);
        while (!ready.empty()) {
            const auto nearest =
                std::min_element(ready.begin(), ready.end(), [&](std::size_t a, std::size_t b) {
                    return std::pair(distance(a, at), a) < std::pair(distance(b, at), b);
                });
            const std::size_t now = *nearest;
            ready.erase(nearest);
            append_cell(cells_[now], at, out);
            for (const std::size_t up : cells_[now].above) {
                if (--cells_[up].below == 0) {
                    ready.push_back(up);
                }
            }
        }
        return out;
    }

    /// To the nearer end of the cell's first line, squared.
    [[nodiscard]] double distance(std::size_t cell, const Vector2d& at) const {
        const std::size_t first = cells_[cell].lines.front();
        return std::min((point(crossings_[sorted_[first]]) - at).squaredNorm(),
                        (point(crossings_[sorted_[first + 1]]) - at).squaredNorm());
    }

    FillPattern pattern_;
    std::vector<Line> loops_;
    std::vector<Crossing> crossings_;
    std::vector<std::size_t> sorted_;  ///< crossings by row, then along it
    std::vector<Cell> cells_;
};

}  // namespace

std::vector<Line> fill_with_lines(const Paths& region, const FillPattern& pattern) {
    return LineFill(region, pattern).lines();
}

std::vector<Line> fill_in_order(const Paths& region, const FillPattern& pattern) {
    return LineFill(region, pattern).lines_in_order();
}

}  // namespace cam::fdm
