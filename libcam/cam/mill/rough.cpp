// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/rough.h"

#include "cam/mill/maps.h"
#include "cam/mill/trace.h"
#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"
#include "cam/polygon/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace cam::mill {

namespace {

using check::HeightMap;
using Eigen::Vector2d;
using Eigen::Vector3d;
using polygon::Paths;

constexpr double kRampSlope = 0.0524;    // 3 degrees
constexpr double kAboveCut = 0.5;        // mm over what is there before a tool slows down
constexpr double kNarrow = 0.1;          // of the diameter: half the least width of a pocket
constexpr double kShortRing = 0.6;       // diameters: a shorter ring is swept by its neighbour
constexpr double kShortRoundRing = 0.1;  // the same of a round tip
constexpr double kRoundStep = 0.25;      // diameters between the rings of a round tip
constexpr double kRestMm = 0.15;         // that a second tool finds worth cutting
constexpr double kThin = 0.02;           // mm by which rings are simplified
constexpr double kWholeLevel = 1e-9;     // of a level: rounding makes no further one
constexpr int kMostRings = 4000;         // of one island

/// One tool at one level.
struct Level {
    double z = 0;
    double above = 0;  ///< everything the tool can reach is clear down to here
    Paths allowed;
};

/// A corner of one of several loops.
struct Corner {
    std::size_t loop = 0;
    std::size_t corner = 0;
};

/// The corner nearest to a place, of loops that are not done.
Corner nearest_corner(const std::vector<std::vector<Vector2d>>& loops,
                      const std::vector<char>& done, const Vector2d& at) {
    Corner best{loops.size(), 0};
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < loops.size(); ++i) {
        for (std::size_t j = 0; done[i] == 0 && j < loops[i].size(); ++j) {
            const double away = (loops[i][j] - at).squaredNorm();
            if (away < nearest) {
                nearest = away;
                best = {i, j};
            }
        }
    }
    return best;
}

class Roughing {
  public:
    Roughing(Writer& writer, const Cutter& cutter, HeightMap tips)
        : writer_(writer), cutter_(cutter), tips_(std::move(tips)) {}

    void cut_level(const Level& level) {
        const double over = ring_step();
        for (const polygon::Island& island : polygon::islands(level.allowed)) {
            std::vector<Paths> rings{island.loops()};
            while (!rings.back().empty() && rings.size() < kMostRings) {
                rings.push_back(polygon::offset(island.loops(),
                                                -over * static_cast<double>(rings.size()),
                                                polygon::Join::Round));
            }
            bool first = true;
            for (std::size_t k = rings.size(); k-- > 0;) {
                cut_rings(rings[k], level, k > 0, first);
            }
        }
    }

  private:
    [[nodiscard]] bool is_round() const {
        return cutter_.tool.shape != tool::Shape::Flat &&
               cutter_.tool.shape != tool::Shape::BullNose;
    }

    /// A round tip leaves ridges between rings: later rapids must not meet them.
    [[nodiscard]] double ring_step() const {
        const double step = cutter_.feeds.rough.step_over_mm;
        return is_round() ? std::min(step, kRoundStep * cutter_.tool.diameter_mm) : step;
    }

    [[nodiscard]] double shortest_ring() const {
        return (is_round() ? kShortRoundRing : kShortRing) * cutter_.tool.diameter_mm;
    }

    void cut_rings(const Paths& rings, const Level& level, bool inner, bool& first) {
        std::vector<std::vector<Vector2d>> loops;
        for (const polygon::Path& ring : polygon::simplified(rings, kThin)) {
            if (inner && polygon::perimeter_mm(ring) < shortest_ring()) {
                continue;
            }
            std::vector<Vector2d>& loop = loops.emplace_back();
            for (const polygon::Point& p : ring) {
                loop.push_back(polygon::to_mm(p));
            }
        }
        std::vector<char> done(loops.size(), 0);
        for (std::size_t count = 0; count < loops.size(); ++count) {
            const Vector2d at = writer_.at() ? Vector2d(writer_.at()->head<2>()) : Vector2d(0, 0);
            const Corner start = nearest_corner(loops, done, at);
            done[start.loop] = 1;
            std::vector<Vector2d>& loop = loops[start.loop];
            std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(start.corner),
                        loop.end());
            cut_ring(loop, level, first);
            first = false;
        }
    }

    void cut_ring(const std::vector<Vector2d>& loop, const Level& level, bool slot) {
        const decomp::Speed feed = slot ? cutter_.feeds.slot.feed : cutter_.feeds.rough.feed;
        if (!step_across(loop.front(), level)) {
            ramp_in(loop, level);
        }
        for (std::size_t i = 1; i <= loop.size(); ++i) {
            const Vector2d& p = loop[i % loop.size()];
            writer_.cut(Vector3d(p.x(), p.y(), level.z), feed);
        }
    }

    /// From the ring just cut straight to the next, if that is near and the way is allowed.
    bool step_across(const Vector2d& to, const Level& level) {
        if (!writer_.is_down() || writer_.at()->z() != level.z) {
            return false;
        }
        const Vector2d from = writer_.at()->head<2>();
        const double away = (to - from).norm();
        if (away > 2 * cutter_.feeds.rough.step_over_mm) {
            return false;
        }
        const int steps = 1 + static_cast<int>(away / tips_.cell_mm);
        for (int i = 0; i <= steps; ++i) {
            const Vector2d at = from + (to - from) * (static_cast<double>(i) / steps);
            if (highest_near(tips_, at) > level.z) {
                return false;
            }
        }
        writer_.cut(Vector3d(to.x(), to.y(), level.z), cutter_.feeds.slot.feed);
        return true;
    }

    void ramp_in(const std::vector<Vector2d>& loop, const Level& level) {
        const Vector2d& start = loop.front();
        const double clear = level.above + kAboveCut;
        double z = std::max(level.z, clear);
        writer_.approach(Vector3d(start.x(), start.y(), z), z, cutter_.feeds.rough.plunge);
        for (std::size_t i = 0; z > level.z; i = (i + 1) % loop.size()) {
            const Vector2d& from = loop[i];
            const Vector2d& to = loop[(i + 1) % loop.size()];
            const double length = (to - from).norm();
            const double fall = length * kRampSlope;
            if (z - fall <= level.z && fall > 0) {
                const Vector2d p = from + (to - from) * ((z - level.z) / fall);
                writer_.cut(Vector3d(p.x(), p.y(), level.z), cutter_.feeds.rough.ramp);
            }
            z = std::max(level.z, z - fall);
            writer_.cut(Vector3d(to.x(), to.y(), z), cutter_.feeds.rough.ramp);
            if (z == level.z) {
                run_to_start(loop, (i + 2) % loop.size(), z);
            }
        }
    }

    /// From a corner round to where the ramp began: what lies under it is cut with the ring.
    void run_to_start(const std::vector<Vector2d>& loop, std::size_t corner, double z) {
        for (std::size_t j = corner; j != 1 % loop.size(); j = (j + 1) % loop.size()) {
            const Vector2d& p = loop[j];
            writer_.cut(Vector3d(p.x(), p.y(), z), cutter_.feeds.slot.feed);
            if (j == 0) {
                break;
            }
        }
    }

    Writer& writer_;
    const Cutter& cutter_;
    HeightMap tips_;
};

/// The region in which a map is at or below a level.
Paths region_below(const HeightMap& map, double level, const HeightMap* needed) {
    Lattice lattice{map.columns, map.rows, map.z_mm};
    const auto high = static_cast<float>(level + 1);
    for (std::size_t i = 0; i < lattice.values.size(); ++i) {
        if (needed != nullptr && needed->z_mm[i] <= level + kRestMm) {
            lattice.values[i] = std::max(lattice.values[i], high);
        }
    }
    for (int column = 0; column < map.columns; ++column) {
        lattice.values[lattice.index(column, 0)] = high;
        lattice.values[lattice.index(column, map.rows - 1)] = high;
    }
    for (int row = 0; row < map.rows; ++row) {
        lattice.values[lattice.index(0, row)] = high;
        lattice.values[lattice.index(map.columns - 1, row)] = high;
    }
    // Nodes at the level, not the line between nodes: between them a wall may stand.
    const auto at_node = [](const Vector2d& below, const Vector2d& above) -> Vector2d {
        return below + 0.02 * (above - below);
    };
    Paths loops;
    for (const Chain& chain : trace_level(lattice, level, {}, at_node)) {
        polygon::Path& loop = loops.emplace_back();
        for (const Vector2d& p : chain.points) {
            loop.push_back(polygon::from_mm(map.low_mm + map.cell_mm * p));
        }
    }
    return polygon::region_of(loops);
}

/// Lowers to `z` the nodes that lie in a region.
void lower_inside(HeightMap& map, const Paths& region, float z) {
    std::vector<std::vector<double>> crossings(static_cast<std::size_t>(map.rows));
    for (const polygon::Path& loop : region) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vector2d a = (polygon::to_mm(loop[i]) - map.low_mm) / map.cell_mm;
            const Vector2d b =
                (polygon::to_mm(loop[(i + 1) % loop.size()]) - map.low_mm) / map.cell_mm;
            const int first = std::max(0, static_cast<int>(std::ceil(std::min(a.y(), b.y()))));
            for (int row = first; row < map.rows && row < std::max(a.y(), b.y()); ++row) {
                crossings[static_cast<std::size_t>(row)].push_back(
                    a.x() + (b.x() - a.x()) * (row - a.y()) / (b.y() - a.y()));
            }
        }
    }
    for (int row = 0; row < map.rows; ++row) {
        std::vector<double>& xs = crossings[static_cast<std::size_t>(row)];
        std::sort(xs.begin(), xs.end());
        for (std::size_t i = 0; i + 1 < xs.size(); i += 2) {
            for (int column = std::max(0, static_cast<int>(std::ceil(xs[i])));
                 column < map.columns && column <= xs[i + 1]; ++column) {
                float& value = map.z_mm[map.index(column, row)];
                value = std::min(value, z);
            }
        }
    }
}

}  // namespace

decomp::Status rough(const Work& work, const Cutter& cutter, bool rest_only, double deepest_step_mm,
                     decomp::Run& run) {
    const Bench& bench = work.bench;
    Writer& writer = work.writer;
    const HeightMap tips =
        lowest_tips_over(work.maps, bench, cutter.tool, work.task.allowance_mm, work.task);
    const HeightMap air = air_tips(work.maps.stock, cutter.tool);
    const double top = bench.program.stock.max().z();
    const double step = std::min(cutter.feeds.rough.step_down_mm, deepest_step_mm);
    const int levels =
        std::max(1, static_cast<int>(std::ceil((top - bench.floor_z) / step - kWholeLevel)));
    HeightMap reached = tips;
    const auto untouched_z = static_cast<float>(bench.program.safe_z);
    std::fill(reached.z_mm.begin(), reached.z_mm.end(), untouched_z);
    writer.take(cutter, cutter.feeds.rough.spindle_rpm,
                rest_only ? path::MillOperation::RestRough : path::MillOperation::Rough);
    Roughing roughing(writer, cutter, tips);
    Paths opened;
    for (int k = 1; k <= levels; ++k) {
        if (run.cancelled()) {
            return decomp::cancelled();
        }
        Level level;
        level.z = top - (top - bench.floor_z) * k / levels;
        level.above = top - (top - bench.floor_z) * (k - 1) / levels;
        level.allowed = polygon::opened(region_below(tips, level.z, rest_only ? &air : nullptr),
                                        kNarrow * cutter.tool.diameter_mm, polygon::Join::Round);
        if (k > 1) {
            // Never below what this tool has not opened from above: no cut deeper than a level.
            level.allowed = polygon::intersect(
                level.allowed,
                rest_only
                    ? polygon::unite(opened, region_below(air, level.above + kRestMm, nullptr))
                    : opened);
        }
        opened = level.allowed;
        roughing.cut_level(level);
        lower_inside(reached, level.allowed, static_cast<float>(level.z));
    }
    writer.retract();
    remove(work.maps.stock, reached, cutter.tool);
    return {};
}

}  // namespace cam::mill
