// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/finish.h"

#include "cam/mill/maps.h"
#include "cam/mill/order.h"
#include "cam/mill/tip.h"
#include "cam/mill/trace.h"
#include "decomp/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace cam::mill {

namespace {

using check::HeightMap;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kAboveCut = 1.0;    // mm over what is there before a tool slows down
constexpr double kOnFloor = 1e-6;    // mm: nothing is finished there
constexpr double kRowSlope = 0.4;    // rises more from row to row: a further row between them
constexpr double kRowShare = 0.928;  // of the stepover: up to that slope no higher scallops
constexpr double kBeside = 0.01;     // mm: the slope at a place is that to a place beside it
constexpr double kLevelShare = 0.8;  // of the stepover: levels on slopes not quite upright
constexpr double kLead = 0.25;       // diameters: a level line begins and ends so far outside
constexpr double kRestMm = 0.05;     // that a second finishing tool finds worth cutting
constexpr double kThinMm = 0.002;
constexpr double kJumpLines = 3;  // stepovers across which a line goes on to the next

/// Places and heights of the lattice of finishing.
struct Grid {
    Lattice lattice;
    Vector2d origin;
    Vector2d along;
    Vector2d across;
    double step = 0;

    [[nodiscard]] Vector2d place(const Vector2d& node) const {
        return origin + step * (node.x() * along + node.y() * across);
    }

    [[nodiscard]] Vector2d place(int column, int row) const { return place(Vector2d(column, row)); }
};

class Finishing {
  public:
    Finishing(const Work& work, const Cutter& cutter, Tip tip)
        : writer_(work.writer),
          bench_(work.bench),
          cutter_(cutter),
          task_(work.task),
          tip_(std::move(tip)),
          air_(air_tips(work.maps.stock, cutter.tool)),
          room_(axis_room(work.bench, cutter.tool)) {}

    [[nodiscard]] bool sample(double step, decomp::Run& run) {
        const double angle = task_.lines.radians();
        grid_.along = {std::cos(angle), std::sin(angle)};
        grid_.across = {-std::sin(angle), std::cos(angle)};
        grid_.step = step;
        Eigen::AlignedBox2d turned;
        for (const double x : {room_.min().x(), room_.max().x()}) {
            for (const double y : {room_.min().y(), room_.max().y()}) {
                const Vector2d p(x, y);
                turned.extend(Vector2d(p.dot(grid_.along), p.dot(grid_.across)));
            }
        }
        grid_.origin = turned.min().x() * grid_.along + turned.min().y() * grid_.across;
        grid_.lattice.columns = 1 + static_cast<int>(turned.sizes().x() / step + kOnFloor);
        grid_.lattice.rows = 1 + static_cast<int>(turned.sizes().y() / step + kOnFloor);
        Lattice& lattice = grid_.lattice;
        lattice.values.assign(
            static_cast<std::size_t>(lattice.columns) * static_cast<std::size_t>(lattice.rows), 0);
        z_.assign(lattice.values.size(), 0);
        decomp::for_each_index(run, static_cast<std::size_t>(lattice.rows), [&](std::size_t r) {
            const int row = static_cast<int>(r);
            for (int column = 0; column < lattice.columns; ++column) {
                const Vector2d at = grid_.place(column, row);
                z_[lattice.index(column, row)] =
                    inside(at) ? tip_.lowest(at) : bench_.program.safe_z;
            }
        });
        for (std::size_t i = 0; i < z_.size(); ++i) {
            lattice.values[i] = static_cast<float>(z_[i]);
        }
        return !run.cancelled();
    }

    /// What is to be done at each node: nothing, a line, a level, or both.
    void sort_by_slope(bool rest_only) {
        const Lattice& lattice = grid_.lattice;
        const double steepest = std::tan(task_.steep.radians());
        std::vector<char> steep(z_.size(), 0);
        std::vector<char> needed(z_.size(), 0);
        for (int row = 0; row < lattice.rows; ++row) {
            for (int column = 0; column < lattice.columns; ++column) {
                const std::size_t i = lattice.index(column, row);
                const Vector2d at = grid_.place(column, row);
                needed[i] = inside(at) && z_[i] < bench_.program.stock.max().z() + kRestMm &&
                            (!rest_only || highest_near(air_, at) > z_[i] + kRestMm);
                if (needed[i] == 0) {
                    continue;
                }
                const double gx = slope(column - 1, row, column + 1, row);
                const double gy = slope(column, row - 1, column, row + 1);
                steep[i] = std::hypot(gx, gy) > steepest;
                figures_.nodes += z_[i] > bench_.floor_z + kOnFloor ? 1 : 0;
                figures_.held_up +=
                    z_[i] > bench_.floor_z + kOnFloor && tip_.body(at) >= z_[i] - kOnFloor ? 1 : 0;
            }
        }
        line_.assign(z_.size(), 0);
        level_.assign(z_.size(), 0);
        for (int row = 0; row < lattice.rows; ++row) {
            for (int column = 0; column < lattice.columns; ++column) {
                const std::size_t i = lattice.index(column, row);
                const bool on_floor = z_[i] <= bench_.floor_z + kOnFloor;
                line_[i] = needed[i] != 0 && !on_floor && gentlest(column, row) <= steepest;
                level_[i] = near(steep, column, row);
            }
        }
    }

    /// What a round tip left at the feet of walls and this flat one can take: lines there.
    void sort_feet() {
        const Lattice& lattice = grid_.lattice;
        const double steepest = std::tan(task_.steep.radians());
        line_.assign(z_.size(), 0);
        level_.assign(z_.size(), 0);
        for (int row = 0; row < lattice.rows; ++row) {
            for (int column = 0; column < lattice.columns; ++column) {
                const std::size_t i = lattice.index(column, row);
                const Vector2d at = grid_.place(column, row);
                const double ground = gentlest(column, row);
                if (usable(column, row) && ground <= steepest) {
                    // The map of the stock is as wrong as the ground rises across its cells.
                    const double worth = kRestMm + ground * std::numbers::sqrt2 * air_.cell_mm;
                    line_[i] = highest_near(air_, at) > z_[i] + worth;
                }
            }
        }
    }

    void levels(double from_z, double to_z, double step) {
        const Lattice& lattice = grid_.lattice;
        writer_.take(cutter_, cutter_.feeds.finish.spindle_rpm, path::MillOperation::Waterline);
        const auto wanted = [&](int column, int row) {
            return level_[lattice.index(column, row)] != 0 ||
                   level_[lattice.index(column + 1, row)] != 0 ||
                   level_[lattice.index(column, row + 1)] != 0 ||
                   level_[lattice.index(column + 1, row + 1)] != 0;
        };
        const int count = std::max(1, static_cast<int>(std::ceil((from_z - to_z) / step)));
        for (int k = 1; k <= count; ++k) {
            const double z = from_z - (from_z - to_z) * k / count;
            const auto crossing = [&](const Vector2d& below, const Vector2d& above) {
                return onto_surface(below, above, z);
            };
            std::vector<Chain> chains = trace_level(lattice, z, wanted, crossing);
            level_lines(chains, z);
        }
        writer_.retract();
    }

    void lines() {
        writer_.take(cutter_, cutter_.feeds.finish.spindle_rpm, path::MillOperation::Parallel);
        std::vector<std::vector<Vector3d>> lines;
        for (int row = 0; row < grid_.lattice.rows; ++row) {
            add_row(row, lines);
            if (row + 1 < grid_.lattice.rows) {
                add_row_between(row, lines);
            }
        }
        std::vector<Stretch> stretches;
        stretches.reserve(lines.size());
        for (const std::vector<Vector3d>& line : lines) {
            stretches.push_back({line.front().head<2>(), line.back().head<2>()});
        }
        const Vector2d start = writer_.at() ? Vector2d(writer_.at()->head<2>()) : room_.min();
        for (const Turn& turn : short_order(stretches, start)) {
            std::vector<Vector3d>& line = lines[turn.index];
            if (turn.backwards) {
                std::reverse(line.begin(), line.end());
            }
            cut_line(line);
        }
        writer_.retract();
    }

    /// Heights at which the tip has been, on the nodes of a map.
    [[nodiscard]] HeightMap heights_on(const HeightMap& like) const {
        HeightMap out = like;
        for (int row = 0; row < out.rows; ++row) {
            for (int column = 0; column < out.columns; ++column) {
                const Vector2d at = out.low_mm + out.cell_mm * Vector2d(column, row);
                out.z_mm[out.index(column, row)] = static_cast<float>(height_at(at));
            }
        }
        return out;
    }

    [[nodiscard]] const Finished& figures() const { return figures_; }

    void mark_all_levels() {
        level_.assign(z_.size(), 1);
        line_.assign(z_.size(), 0);
    }

  private:
    [[nodiscard]] Vector3d node(int column, int row) const {
        const Vector2d at = grid_.place(column, row);
        return {at.x(), at.y(), z_[grid_.lattice.index(column, row)]};
    }

    /// The lines of a row.
    void add_row(int row, std::vector<std::vector<Vector3d>>& lines) const {
        const Lattice& lattice = grid_.lattice;
        for (int column = 0; column < lattice.columns; ++column) {
            if (line_[lattice.index(column, row)] == 0) {
                continue;
            }
            int last = column;
            while (last + 1 < lattice.columns && line_[lattice.index(last + 1, row)] != 0) {
                ++last;
            }
            // One node into the steep at either end.
            const int first = column > 0 && usable(column - 1, row) ? column - 1 : column;
            const int end = last + 1 < lattice.columns && usable(last + 1, row) ? last + 1 : last;
            std::vector<Vector3d>& line = lines.emplace_back();
            for (int c = first; c <= end; ++c) {
                line.push_back(node(c, row));
            }
            column = last;
        }
    }

    /// Lines between a row and the next, where the surface rises from one to the other.
    void add_row_between(int row, std::vector<std::vector<Vector3d>>& lines) const {
        bool going_on = false;
        for (int column = 0; column < grid_.lattice.columns; ++column) {
            const std::optional<Vector3d> between = node_between(column, row);
            if (between) {
                if (!going_on) {
                    lines.emplace_back();
                }
                lines.back().push_back(*between);
            }
            going_on = between.has_value();
        }
    }

    /// Where a further line passes between two nodes of a column: at the foot of a wall right
    /// beside it, for a round tip that stays off leaves the whole corner; on a slope midway.
    [[nodiscard]] std::optional<Vector3d> node_between(int column, int row) const {
        const Vector3d one = node(column, row);
        const Vector3d other = node(column, row + 1);
        const Vector3d& low = one.z() < other.z() ? one : other;
        const Vector3d& high = one.z() < other.z() ? other : one;
        const int low_row = one.z() < other.z() ? row : row + 1;
        if (line_[grid_.lattice.index(column, low_row)] == 0 || !usable(column, row) ||
            !usable(column, row + 1) || high.z() - low.z() <= kRowSlope * grid_.step) {
            return std::nullopt;
        }
        const double steepest = std::tan(task_.steep.radians());
        const Vector2d up = (high - low).head<2>() / grid_.step;
        const auto place = [&](double share) -> Vector2d {
            return low.head<2>() + share * grid_.step * up;
        };
        // Up the wall, or on what lies above it: steeply above the low node.
        const auto is_steep = [&](double share) {
            const double here = tip_.lowest(place(share));
            const double beside = tip_.lowest(place(share) + kBeside * up);
            return beside - here > steepest * kBeside ||
                   beside - low.z() > steepest * (share * grid_.step + kBeside);
        };
        double share = 0.5;
        if (high.z() - low.z() > steepest * grid_.step && !is_steep(0)) {
            double wall = 1;
            share = 0;
            while ((wall - share) * grid_.step > kPlaceMm) {
                const double middle = (wall + share) / 2;
                (is_steep(middle) ? wall : share) = middle;
            }
        }
        const Vector2d at = place(share);
        return Vector3d(at.x(), at.y(), tip_.lowest(at));
    }

    /// The slope on the gentler side of a node along the rows and across them: at the foot of a
    /// wall and at its brink that is the ground's.
    [[nodiscard]] double gentlest(int column, int row) const {
        const double x = std::min(std::abs(slope(column - 1, row, column, row)),
                                  std::abs(slope(column, row, column + 1, row)));
        const double y = std::min(std::abs(slope(column, row - 1, column, row)),
                                  std::abs(slope(column, row, column, row + 1)));
        return std::hypot(x, y);
    }

    /// The highest that the tip has been around a place; the safe height where it has not been.
    [[nodiscard]] double height_at(const Vector2d& at) const {
        const Vector2d from = at - grid_.origin;
        const int column = static_cast<int>(std::lround(from.dot(grid_.along) / grid_.step));
        const int row = static_cast<int>(std::lround(from.dot(grid_.across) / grid_.step));
        if (column < 0 || row < 0 || column >= grid_.lattice.columns || row >= grid_.lattice.rows) {
            return bench_.program.safe_z;
        }
        const std::size_t i = grid_.lattice.index(column, row);
        return line_[i] != 0 || level_[i] != 0 ? highest_around(column, row)
                                               : bench_.program.safe_z;
    }

    [[nodiscard]] bool inside(const Vector2d& at) const { return room_.contains(at); }

    [[nodiscard]] bool usable(int column, int row) const {
        const std::size_t i = grid_.lattice.index(column, row);
        return inside(grid_.place(column, row)) && z_[i] > bench_.floor_z + kOnFloor;
    }

    [[nodiscard]] double slope(int c0, int r0, int c1, int r1) const {
        const Lattice& lattice = grid_.lattice;
        const auto fit = [](int value, int count) { return std::clamp(value, 0, count - 1); };
        c0 = fit(c0, lattice.columns);
        c1 = fit(c1, lattice.columns);
        r0 = fit(r0, lattice.rows);
        r1 = fit(r1, lattice.rows);
        const double run = grid_.step * std::hypot(c1 - c0, r1 - r0);
        if (run == 0 || !inside(grid_.place(c0, r0)) || !inside(grid_.place(c1, r1))) {
            return 0;
        }
        return (z_[lattice.index(c1, r1)] - z_[lattice.index(c0, r0)]) / run;
    }

    [[nodiscard]] bool near(const std::vector<char>& mask, int column, int row) const {
        const Lattice& lattice = grid_.lattice;
        for (int r = std::max(0, row - 1); r <= std::min(lattice.rows - 1, row + 1); ++r) {
            for (int c = std::max(0, column - 1); c <= std::min(lattice.columns - 1, column + 1);
                 ++c) {
                if (mask[lattice.index(c, r)] != 0) {
                    return true;
                }
            }
        }
        return false;
    }

    [[nodiscard]] double highest_around(int column, int row) const {
        const Lattice& lattice = grid_.lattice;
        double z = z_[lattice.index(column, row)];
        for (int r = std::max(0, row - 1); r <= std::min(lattice.rows - 1, row + 1); ++r) {
            for (int c = std::max(0, column - 1); c <= std::min(lattice.columns - 1, column + 1);
                 ++c) {
                z = std::max(z, z_[lattice.index(c, r)]);
            }
        }
        return z;
    }

    /// Between a node that is clear at z and one that is not: the last clear place, by bisection.
    [[nodiscard]] Vector2d onto_surface(const Vector2d& below, const Vector2d& above,
                                        double z) const {
        Vector2d clear = below;
        Vector2d blocked = above;
        while ((blocked - clear).norm() * grid_.step > kPlaceMm) {
            const Vector2d middle = (clear + blocked) / 2;
            (tip_.clears(grid_.place(middle), z) ? clear : blocked) = middle;
        }
        return clear;
    }

    /// From `from` along a direction, clear or not by `start`, to where that changes: the last
    /// clear distance, within kPlaceMm; nothing within `farthest`.
    [[nodiscard]] std::optional<double> brink(const Vector2d& from, const Vector2d& direction,
                                              bool start_clear, double start, double farthest,
                                              double z) const {
        double near = start;
        double far = 2 * start;
        while (far < farthest && tip_.clears(from + far * direction, z) == start_clear) {
            near = far;
            far *= 2;
        }
        if (far >= farthest) {
            return std::nullopt;
        }
        while (far - near > kPlaceMm) {
            const double half = (near + far) / 2;
            (tip_.clears(from + half * direction, z) == start_clear ? near : far) = half;
        }
        return start_clear ? near : far;
    }

    /// Moves a chord's middle onto the surface, out of what it cuts or into the hollow that it
    /// passes over, and asks again for its halves.
    void clear_chord(const Vector2d& a, const Vector2d& b, double z, int depth,
                     std::vector<Vector3d>& out) const {
        const Vector2d along = b - a;
        const double length = along.norm();
        if (depth == 0 || length <= kShortest) {
            return;
        }
        const Vector2d free(-along.y() / length, along.x() / length);  // clear is to the left
        const Vector2d middle = (a + b) / 2;
        std::optional<Vector2d> split;
        const bool cuts = !tip_.clears(middle + kFinishToleranceMm * free, z);
        if (cuts) {
            if (const auto by = brink(middle, free, false, kFinishToleranceMm, length, z)) {
                split = middle + *by * free;
            }
        } else if (length > kCoarsest && tip_.clears(middle - kDip * free, z)) {
            if (const auto by = brink(middle, -free, true, kDip, length, z)) {
                split = middle - *by * free;
            }
        }
        if (split) {
            clear_chord(a, *split, z, depth - 1, out);
            out.emplace_back(split->x(), split->y(), z);
            clear_chord(*split, b, z, depth - 1, out);
        } else if (cuts) {
            // No way round at this height: over it.
            std::vector<Vector3d> over;
            tip_.follow(Vector3d(a.x(), a.y(), z), Vector3d(b.x(), b.y(), z), over);
            for (Vector3d& p : over) {
                p.z() = std::max(p.z(), z);
                out.push_back(p);
            }
        }
    }

    /// Where a chain may be entered.
    struct Entry {
        std::size_t chain = 0;
        std::size_t corner = 0;
    };

    /// The entry nearest to where the tip is, of chains that are not done: a closed one is entered
    /// at any corner.
    [[nodiscard]] Entry nearest_entry(const std::vector<Chain>& chains,
                                      const std::vector<char>& done) const {
        const Vector2d at = writer_.at() ? Vector2d(writer_.at()->head<2>()) : room_.min();
        Entry best;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < chains.size(); ++i) {
            const std::size_t starts = chains[i].closed ? chains[i].points.size() : 1;
            for (std::size_t j = 0; done[i] == 0 && j < starts; ++j) {
                const double away = (grid_.place(chains[i].points[j]) - at).squaredNorm();
                if (away < nearest) {
                    nearest = away;
                    best = {i, j};
                }
            }
        }
        return best;
    }

    void level_lines(std::vector<Chain>& chains, double z) {
        std::vector<char> done(chains.size(), 0);
        for (std::size_t count = 0; count < chains.size(); ++count) {
            const Entry entry = nearest_entry(chains, done);
            done[entry.chain] = 1;
            Chain& chain = chains[entry.chain];
            std::rotate(chain.points.begin(),
                        chain.points.begin() + static_cast<std::ptrdiff_t>(entry.corner),
                        chain.points.end());
            if (chain.closed) {
                chain.points.push_back(chain.points.front());
            }
            if (chain.points.size() > 1) {
                cut_level_line(chain, z);
            }
        }
    }

    void cut_level_line(const Chain& chain, double z) {
        std::vector<Vector3d> points;
        for (std::size_t i = 0; i < chain.points.size(); ++i) {
            const Vector2d p = grid_.place(chain.points[i]);
            if (i > 0) {
                clear_chord(Vector2d(points.back().head<2>()), p, z, 6, points);
            }
            points.emplace_back(p.x(), p.y(), z);
        }
        points = thinned(points, kThinMm);
        const auto lead = [&](const Vector3d& end,
                              const Vector3d& next) -> std::optional<Vector3d> {
            const Vector2d along = (next - end).head<2>().normalized();
            const Vector2d out = Vector2d(-along.y(), along.x()) * kLead * cutter_.tool.diameter_mm;
            const Vector2d at = Vector2d(end.head<2>()) + out;
            if (inside(at) && tip_.clears(at, z) &&
                tip_.clears(Vector2d(end.head<2>()) + out / 2, z)) {
                return Vector3d(at.x(), at.y(), z);
            }
            return std::nullopt;
        };
        if (!step_over_to(points.front(), z)) {
            const auto in = lead(points.front(), points[1]);
            const Vector3d& start = in ? *in : points.front();
            writer_.approach(start, clear_above(start), cutter_.feeds.finish.plunge);
        }
        writer_.cut_along(points, cutter_.feeds.finish.feed);
        if (!chain.closed) {
            const std::size_t n = points.size();
            const Vector3d beyond = 2 * points[n - 1] - points[n - 2];
            if (const auto away = lead(points[n - 1], beyond)) {
                writer_.cut(*away, cutter_.feeds.finish.feed);
            }
        }
    }

    /// From a line just cut to the next one below it, without going up.
    bool step_over_to(const Vector3d& to, double z) {
        if (!writer_.is_down() || writer_.at()->z() < z) {
            return false;
        }
        const Vector3d from = *writer_.at();
        const double away = (to - from).head<2>().norm();
        if (away > kJumpLines * grid_.step || from.z() - z > 2 * kJumpLines * grid_.step) {
            return false;
        }
        for (const double share : {0.25, 0.5, 0.75, 1.0}) {
            const Vector2d at = from.head<2>() + share * (to - from).head<2>();
            if (!tip_.clears(at, from.z())) {
                return false;
            }
        }
        writer_.cut(Vector3d(to.x(), to.y(), from.z()), cutter_.feeds.finish.feed);
        writer_.cut(to, cutter_.feeds.finish.plunge);
        return true;
    }

    [[nodiscard]] double clear_above(const Vector3d& at) const {
        return std::max<double>(at.z(), highest_near(air_, at.head<2>())) + kAboveCut;
    }

    void cut_line(const std::vector<Vector3d>& nodes) {
        const double reach = kJumpLines * grid_.step;
        std::vector<Vector3d> points;
        if (writer_.is_down() && (nodes.front() - *writer_.at()).head<2>().norm() < reach) {
            points.push_back(*writer_.at());
            tip_.follow(points.front(), nodes.front(), points);
        } else {
            writer_.approach(nodes.front(), clear_above(nodes.front()),
                             cutter_.feeds.finish.plunge);
            points.push_back(nodes.front());
        }
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            tip_.follow(nodes[i - 1], nodes[i], points);
        }
        writer_.cut_along(thinned(points, kThinMm), cutter_.feeds.finish.feed);
    }

    Writer& writer_;
    const Bench& bench_;
    const Cutter& cutter_;
    const MillTask& task_;
    Tip tip_;
    HeightMap air_;
    Eigen::AlignedBox2d room_;
    Grid grid_;
    std::vector<double> z_;
    std::vector<char> line_;
    std::vector<char> level_;
    Finished figures_;
};

}  // namespace

decomp::Result<Finished> finish(const Work& work, const cutter::Surface& surface,
                                const Cutter& cutter, bool rest_only, decomp::Run& run) {
    const Bench& bench = work.bench;
    HeightMap& stock = work.maps.stock;
    Finishing finishing(
        work, cutter,
        Tip(surface, cutter.tool, body_tips(stock, cutter.tool, work.task), bench.floor_z));
    const double step = stepover_mm(cutter.tool, work.task.scallop_mm);
    if (!finishing.sample(kRowShare * step, run)) {
        return decomp::cancelled();
    }
    finishing.sort_by_slope(rest_only);
    finishing.levels(bench.program.stock.max().z(), bench.floor_z, kLevelShare * step);
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    finishing.lines();
    remove(stock, finishing.heights_on(stock), cutter.tool);
    return finishing.figures();
}

decomp::Status feet(const Work& work, const cutter::Surface& surface, const Cutter& cutter,
                    double step_mm, decomp::Run& run) {
    Finishing finishing(work, cutter,
                        Tip(surface, cutter.tool,
                            body_tips(work.maps.stock, cutter.tool, work.task),
                            work.bench.floor_z));
    if (!finishing.sample(step_mm, run)) {
        return decomp::cancelled();
    }
    finishing.sort_feet();
    finishing.lines();
    return {};
}

decomp::Status contour(const Work& work, const cutter::Surface& surface, const Cutter& cutter,
                       double from_z, double step_mm, decomp::Run& run) {
    const double floor_z = work.bench.floor_z;
    Finishing finishing(
        work, cutter,
        Tip(surface, cutter.tool, body_tips(work.maps.stock, cutter.tool, work.task), floor_z));
    if (!finishing.sample(step_mm, run)) {
        return decomp::cancelled();
    }
    finishing.mark_all_levels();
    finishing.levels(from_z, floor_z, step_mm);
    return {};
}

}  // namespace cam::mill
