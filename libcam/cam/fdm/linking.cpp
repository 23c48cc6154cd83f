// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/linking.h"

#include "cam/fdm/disjoint_sets.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;

constexpr std::size_t kNone = ~std::size_t{0};
constexpr double kHookMm = 2.5;

/// A way along the boundary, in the loop's direction, from one line's end to the next one's.
struct Link {
    std::size_t from = 0;  ///< end 2 i is the beginning of line i, 2 i + 1 its end
    std::size_t to = 0;
    double length_mm = 0;
};

class Linker {
  public:
    Linker(std::vector<BoundedLine> lines, const EdgeGrid& region, double max_link_mm)
        : lines_(std::move(lines)),
          region_(region),
          max_link_mm_(max_link_mm),
          link_(2 * lines_.size(), kNone),
          free_mm_(2 * lines_.size(), 0),
          forward_(2 * lines_.size(), 1) {}

    std::vector<Line> lines() {
        join();
        return chains();
    }

  private:
    [[nodiscard]] const BoundaryPoint& end(std::size_t e) const {
        return lines_[e / 2].ends.at(e % 2);
    }

    /// Length along the loop's direction; stops counting beyond the limit.
    [[nodiscard]] double way_mm(const BoundaryPoint& from, const BoundaryPoint& to) const {
        const auto& loop = region_.loops()[from.loop];
        Vector2d at = from.at_mm;
        double sum = 0;
        if (from.edge != to.edge || from.on_edge > to.on_edge) {
            std::size_t v = from.edge;
            do {
                v = (v + 1) % loop.size();
                sum += (loop[v] - at).norm();
                at = loop[v];
            } while (v != to.edge && sum <= max_link_mm_);
        }
        return sum + (to.at_mm - at).norm();
    }

    void join() {
        std::vector<std::size_t> order(link_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            const BoundaryPoint& p = end(a);
            const BoundaryPoint& q = end(b);
            return std::tie(p.loop, p.edge, p.on_edge, a) < std::tie(q.loop, q.edge, q.on_edge, b);
        });
        std::vector<Link> links;
        for (std::size_t begin = 0; begin < order.size();) {
            std::size_t stop = begin;
            while (stop < order.size() && end(order[stop]).loop == end(order[begin]).loop) {
                ++stop;
            }
            for (std::size_t i = begin; i < stop && stop - begin > 1; ++i) {
                const std::size_t j = i + 1 < stop ? i + 1 : begin;
                const double length = way_mm(end(order[i]), end(order[j]));
                free_mm_[order[i]] = length;
                if (length <= max_link_mm_) {
                    links.push_back({order[i], order[j], length});
                }
            }
            begin = stop;
        }
        std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
            return std::tie(a.length_mm, a.from) < std::tie(b.length_mm, b.from);
        });
        DisjointSets sets(lines_.size());
        for (const Link& l : links) {
            if (link_[l.from] == kNone && link_[l.to] == kNone && sets.join(l.from / 2, l.to / 2)) {
                link_[l.from] = l.to;
                link_[l.to] = l.from;
                forward_[l.to] = 0;
            }
        }
    }

    /// Appends the boundary's vertices between an end and the one it is linked to.
    void append_link(std::size_t from, Line& out) const {
        const bool forward = forward_[from] != 0;
        const BoundaryPoint& first = end(forward ? from : link_[from]);
        const BoundaryPoint& last = end(forward ? link_[from] : from);
        const auto& loop = region_.loops()[first.loop];
        Line between;
        if (first.edge != last.edge || first.on_edge > last.on_edge) {
            std::size_t v = first.edge;
            do {
                v = (v + 1) % loop.size();
                between.push_back(loop[v]);
            } while (v != last.edge);
        }
        if (!forward) {
            std::reverse(between.begin(), between.end());
        }
        out.insert(out.end(), between.begin(), between.end());
    }

    /// An end without a link holds on to the wall by a short piece along the boundary, in the
    /// loop's direction so that no two of them meet.
    [[nodiscard]] Line hook(std::size_t e) const {
        Line out;
        double left = max_link_mm_ > 0 ? std::min(kHookMm, free_mm_[e] - kHookMm) : 0;
        const BoundaryPoint& from = end(e);
        const auto& loop = region_.loops()[from.loop];
        Vector2d at = from.at_mm;
        for (std::size_t v = (from.edge + 1) % loop.size(); left > 0; v = (v + 1) % loop.size()) {
            const double length = (loop[v] - at).norm();
            if (length > 0) {
                at += std::min(1.0, left / length) * (loop[v] - at);
                out.push_back(at);
            }
            left -= length;
        }
        return out;
    }

    [[nodiscard]] std::vector<Line> chains() const {
        std::vector<Line> out;
        std::vector<char> used(lines_.size(), 0);
        for (std::size_t start = 0; start < link_.size(); ++start) {
            if (used[start / 2] != 0 || link_[start] != kNone) {
                continue;
            }
            Line chain = hook(start);
            std::reverse(chain.begin(), chain.end());
            for (std::size_t e = start;;) {
                used[e / 2] = 1;
                const Line& line = lines_[e / 2].points;
                if (e % 2 == 0) {
                    chain.insert(chain.end(), line.begin(), line.end());
                } else {
                    chain.insert(chain.end(), line.rbegin(), line.rend());
                }
                const std::size_t other = e ^ 1U;
                if (link_[other] == kNone) {
                    const Line last = hook(other);
                    chain.insert(chain.end(), last.begin(), last.end());
                    break;
                }
                append_link(other, chain);
                e = link_[other];
            }
            out.push_back(std::move(chain));
        }
        return out;
    }

    std::vector<BoundedLine> lines_;
    const EdgeGrid& region_;
    double max_link_mm_;
    std::vector<std::size_t> link_;  ///< of each end, the end that it is joined to
    std::vector<double> free_mm_;    ///< from each end to the next along the boundary
    std::vector<char> forward_;      ///< whether that way runs in the loop's direction
};

}  // namespace

void append_inside(const Line& line, const EdgeGrid& region, std::vector<BoundedLine>& out) {
    BoundedLine piece;
    bool inside = false;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        for (const Meeting& m : region.meetings(line[i], line[i + 1])) {
            piece.points.push_back(m.point.at_mm);
            piece.ends.at(inside ? 1 : 0) = m.point;
            if (inside) {
                out.push_back(std::move(piece));
                piece = {};
            }
            inside = !inside;
        }
        if (inside) {
            piece.points.push_back(line[i + 1]);
        }
    }
}

std::vector<Line> linked(std::vector<BoundedLine> lines, const EdgeGrid& region,
                         double max_link_mm) {
    return Linker(std::move(lines), region, max_link_mm).lines();
}

}  // namespace cam::fdm
